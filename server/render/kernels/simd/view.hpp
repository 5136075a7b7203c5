// Where pixels lie in the world, for host kernels: the functions of shaders/lib/frame.glsl in
// vectors. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_VIEW_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_VIEW_HPP
#undef HELIOGRAPH_KERNELS_VIEW_HPP
#else
#define HELIOGRAPH_KERNELS_VIEW_HPP
#endif

#include <cmath>

#include "render/kernels/simd/pixels.hpp"
#include "shaders/shared/frame_constants.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `matrix` x (p, 1), its first three rows.
template <class V>
HWY_INLINE Triple<V> transformed(const glm::mat4& m, const Triple<V>& p) {
  const hn::DFromV<V> d;
  const auto row = [&](int i) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, m[0][i]), p.x,
                      hn::MulAdd(hn::Set(d, m[1][i]), p.y,
                                 hn::MulAdd(hn::Set(d, m[2][i]), p.z, hn::Set(d, m[3][i]))));
  };
  return {row(0), row(1), row(2)};
}

/// The pixels of one row at a time, as the eye sees them.
template <class D>
class ViewedRow {
  using V = hn::Vec<D>;

 public:
  HWY_INLINE ViewedRow(const shared::FrameConstants& frame, int y)
      : frame_(frame),
        orthographic_((frame.flags & shared::frame_orthographic) != 0),
        slope_y_(
            ((static_cast<float>(y) + 0.5f) / static_cast<float>(frame.extent.y) * 2.0f - 1.0f) *
                frame.unproject.y +
            frame.unproject.w) {}

  bool orthographic() const { return orthographic_; }

  /// View-space position of the samples of pixels from `x` on.
  HWY_INLINE Triple<V> view_position(int x, V view_z) const {
    const float scale = 2.0f / static_cast<float>(frame_.extent.x);
    const V ndc = hn::MulAdd(hn::Iota(d_, static_cast<float>(x) + 0.5f), set(scale), set(-1.0f));
    const V slope_x = hn::MulAdd(ndc, set(frame_.unproject.x), set(frame_.unproject.z));
    const V slope_y = set(slope_y_);
    if (orthographic_) return {slope_x, slope_y, hn::Neg(view_z)};
    return {slope_x * view_z, slope_y * view_z, hn::Neg(view_z)};
  }

  HWY_INLINE Triple<V> world_position(int x, V view_z) const {
    return transformed(frame_.inverse_view, view_position(x, view_z));
  }

  /// Unit vectors toward the eye, world space.
  HWY_INLINE Triple<V> to_eye(int x) const {
    const glm::mat4& m = frame_.inverse_view;
    if (orthographic_) return splat(d_, glm::normalize(glm::vec3(m[2])));
    const Triple<V> view = view_position(x, set(-1.0f));
    return normalized(Triple<V>{
        hn::MulAdd(set(m[0][0]), view.x, hn::MulAdd(set(m[1][0]), view.y, set(m[2][0]) * view.z)),
        hn::MulAdd(set(m[0][1]), view.x, hn::MulAdd(set(m[1][1]), view.y, set(m[2][1]) * view.z)),
        hn::MulAdd(set(m[0][2]), view.x, hn::MulAdd(set(m[1][2]), view.y, set(m[2][2]) * view.z))});
  }

  /// How many pixels wide the lobe of a smooth surface shows what is far away.
  HWY_INLINE V lobe_pixels(V roughness) const {
    return orthographic_ ? set(1e6f) : set(2.0f) * roughness * roughness / footprint(set(1.0f));
  }

  /// Size of a pixel at `view_z` metres along -Z, metres.
  HWY_INLINE V footprint(V view_z) const {
    const float height = 2.0f * std::abs(frame_.unproject.y) / static_cast<float>(frame_.extent.y);
    return orthographic_ ? set(height) : set(height) * view_z;
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  const D d_{};
  const shared::FrameConstants& frame_;
  bool orthographic_;
  float slope_y_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
