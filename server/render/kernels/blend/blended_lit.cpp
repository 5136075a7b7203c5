#include "render/kernels/blend/blended.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_lit.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

void list_lit_tile(const BlendedLitJob& job, const Tile& tile) {
  PixelList lit;
  for_each_row(tile, [&](const TileRow& row) HWY_ATTR {
    lit.add(row.pixels, hn::And(row.inside, hn::Gt(row_last(job.radiance, row), zero())));
  });
  if (lit.size() == 0) return;
  const CameraLanes camera(job.frame);
  RayBatch made;
  for (int i = 0; i < lit.size(); i += static_cast<int>(hn::Lanes(tag))) {
    Mask valid;
    const PixelLanes pixel = lit.from(i, valid);
    made.add(camera_rays(job.frame, camera, pixel), valid);
  }
  made.append_to(job.lit);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(list_lit_tile);

void blended_lit(const BlendedLitJob& job) {
  for_each_tile(job.width, {0, job.height}, [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(list_lit_tile)(job, tile);
  });
  job.lit.end();
}

}  // namespace heliograph::render::kernels
#endif
