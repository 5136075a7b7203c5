// The plane through a pixel, for weights of its neighbours: plane_distance() and depth_exponent()
// of shaders/lib/denoise/edge_stopping.glsl in vectors. Included once per instruction set; the
// guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_SURFACE_PLANE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SURFACE_PLANE_HPP
#undef HELIOGRAPH_KERNELS_SURFACE_PLANE_HPP
#else
#define HELIOGRAPH_KERNELS_SURFACE_PLANE_HPP
#endif

#include "render/kernels/simd/edge_stopping.hpp"
#include "render/kernels/simd/view.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class V>
struct SurfacePlane {
  V view_z;       // metres along -Z
  Pair<V> slope;  // of Z, per pixel
  V curve;        // 1 / Z, 0 in orthographic views
  V flattened;    // 1 - Z * curve
  V footprint;    // half of a pixel's, metres

  /// `exponent`, in octaves, less what view Z `z` of a neighbour misses the plane by, as a share of
  /// `sigma` times what it may. The neighbour is `dx` and `dy` pixels away, `apart` in all.
  HWY_INLINE V lowered(V exponent, V z, V dx, V dy, V apart, float sigma) const {
    const hn::DFromV<V> d;
    const V rise = hn::MulAdd(slope.x, dx, slope.y * dy);
    const V straight = hn::NegMulAdd(rise, curve, hn::Set(d, 1.0f));
    const V off_plane = hn::Abs(hn::NegMulAdd(rise, flattened, hn::MulSub(z, straight, view_z)));
    const V allowed = hn::MulAdd(footprint, apart, hn::Abs(rise));
    const V inv_allowed = hn::ApproximateReciprocal(
        hn::Max(allowed * hn::Set(d, sigma / octaves), hn::Set(d, 1e-30f)));
    return hn::NegMulAdd(off_plane, inv_allowed, exponent);
  }
};

/// Of pixels in the row of `view`, at `view_z` metres along -Z, which changes by `slope` per pixel.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfacePlane<V> surface_plane(const ViewedRow<D>& view, V view_z, const Pair<V>& slope) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const bool flat = view.orthographic();
  return {view_z, slope, flat ? zero : one / hn::Max(view_z, hn::Set(d, 1e-20f)), flat ? one : zero,
          hn::Set(d, 0.5f) * view.footprint(view_z)};
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
