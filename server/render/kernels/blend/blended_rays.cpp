#include <cmath>

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// camera_ray() of shaders/lib/rays/camera_ray.glsl, which ends before the G-buffer's surfaces.
class BlendedRays {
 public:
  explicit BlendedRays(const BlendedRaysJob& job) : job_(job), camera_(job.frame) {
    const glm::mat4& m = job.frame.unjittered;
    // The third row of a projection without its view: depth = scale x view Z + offset.
    near_ = m[3][2];
    if (!camera_.orthographic()) return;
    const glm::vec3 row(m[0][2], m[1][2], m[2][2]);
    const float scale = glm::length(row);
    const float at_eye = glm::dot(row, glm::vec3(job.frame.eye)) + m[3][2];
    near_ = (at_eye - 1.0f) / scale;
    far_ = at_eye / scale;
  }

  void run(const Tile& tile) const {
    PixelList traced;
    for_each_row(tile, [&](const TileRow& row) {
      const PixelLanes& pixel = row.pixels;
      const glm::ivec4 region(job_.constants.region);
      const Mask right = float_mask(
          hn::And(hn::Gt(pixel.x, integer(region.x - 1)), hn::Lt(pixel.x, integer(region.z))));
      const Mask down = float_mask(
          hn::And(hn::Gt(pixel.y, integer(region.y - 1)), hn::Lt(pixel.y, integer(region.w))));
      traced.add(pixel, hn::And(row.inside, hn::And(right, down)));
    });
    RayBatch made;
    for (int i = 0; i < traced.size(); i += static_cast<int>(hn::Lanes(tag))) {
      Mask valid;
      const PixelLanes pixel = traced.from(i, valid);
      made.add(ray(pixel), valid);
    }
    made.append_to(job_.rays);
  }

 private:
  HWY_INLINE RayLanes ray(const PixelLanes& pixel) const {
    const Float stretch =
        camera_.orthographic() ? one() : length(camera_.view_position(pixel, one()));
    RayLanes made;
    made.origin = camera_.orthographic() ? camera_.world_position(pixel, zero())
                                         : numbers(glm::vec3(job_.frame.eye));
    made.direction = -camera_.to_eye(pixel);
    made.t_min = stretch * number(std::max(near_, 0.0f));
    // Not the surface itself, whose depth has been rounded.
    const Float view_z = gathered_last(job_.motion, pixel);
    const Float surface = view_z * stretch * number(1.0f - 1e-5f);
    made.t_max = select(hn::Gt(view_z, zero()), hn::Min(surface, number(far_)), number(far_));
    made.pixel = pack_pixel(pixel);
    made.user = numbers(0.0f);
    return made;
  }

  const BlendedRaysJob& job_;
  CameraLanes camera_;
  float near_ = 0.0f, far_ = 1e30f;  // metres along the view
};

void blended_ray_tile(const BlendedRaysJob& job, const Tile& tile) {
  BlendedRays(job).run(tile);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(blended_ray_tile);

void blended_rays(const BlendedRaysJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    const auto width = static_cast<std::size_t>(job.width);
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      std::fill_n(job.radiance.row<float>(row), 4 * width, 0.0f);
      std::fill_n(job.transmittance.row<glm::vec4>(row), width, glm::vec4(1.0f, 1.0f, 1.0f, 0.0f));
      std::copy_n(job.motion.row<const float>(row), 4 * width, job.front_motion.row<float>(row));
      std::fill_n(job.surface.row<std::uint32_t>(row), width, 0u);
      std::fill_n(job.specular.row<float>(row), 4 * width, 0.0f);
    }
  });
  for_each_tile(job.width, {0, job.height}, [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(blended_ray_tile)(job, tile);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
