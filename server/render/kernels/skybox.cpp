#include "render/kernels/skybox.hpp"

#include <array>
#include <cstring>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/skybox.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/ray_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class Skybox {
 public:
  explicit Skybox(const SkyboxJob& job)
      : job_(job),
        camera_(job.frame),
        visible_((job.frame.flags & shared::frame_environment_visible) != 0) {}

  void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(tag));
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < job_.width; x += lanes) block(x, y, std::min(lanes, job_.width - x));
    }
  }

 private:
  static constexpr std::size_t most = 4 * hn::MaxLanes(Tag());

  /// Of `count` pixels, at most a vector of them.
  HWY_INLINE void block(int x, int y, int count) const {
    const Mask covered = hn::Gt(view_z(x, y, count), zero());
    const Mask sky = hn::AndNot(covered, hn::FirstN(tag, lanes_of(count)));
    Float3 radiance = numbers(0.0f);
    if (visible_ && !none(sky)) {
      const PixelLanes pixel{hn::Iota(integer_tag, x), integer(y)};
      radiance = keep(sky, radiance_from(job_.map, job_.frame, -camera_.to_eye(pixel),
                                         job_.frame.background_intensity));
    }
    const Float4 texels{radiance.x, radiance.y, radiance.z, one()};
    float* const to = row_of<float>(job_.background, y) + 4 * x;
    if (lanes_of(count) == hn::Lanes(tag)) {
      store4(tag, texels, to);
      return;
    }
    HWY_ALIGN std::array<float, most> values;
    store4(tag, texels, values.data());
    std::memcpy(to, values.data(), lanes_of(count) * 4 * sizeof(float));
  }

  HWY_INLINE Float view_z(int x, int y, int count) const {
    const float* const from = row_of<const float>(job_.motion, y) + 4 * x;
    if (lanes_of(count) == hn::Lanes(tag)) return load4(tag, from).w;
    HWY_ALIGN std::array<float, most> values{};
    std::memcpy(values.data(), from, lanes_of(count) * 4 * sizeof(float));
    return load4(tag, values.data()).w;
  }

  static std::size_t lanes_of(int count) { return static_cast<std::size_t>(count); }

  const SkyboxJob& job_;
  CameraLanes camera_;
  bool visible_;
};

void skybox_rows(const SkyboxJob& job, int first, int last) {
  Skybox(job).rows(first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(skybox_rows);

void skybox(const SkyboxJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(skybox_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
