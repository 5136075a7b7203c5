// The blended surfaces that pixels have chosen to trace rays for. Included once per instruction
// set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_CHOSEN_HIT_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_CHOSEN_HIT_HPP
#undef HELIOGRAPH_KERNELS_CHOSEN_HIT_HPP
#else
#define HELIOGRAPH_KERNELS_CHOSEN_HIT_HPP
#endif

#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// The hits that the pixels chose and what of their light reaches the eye, divided by the chance of
/// the choice.
template <class Job>
HWY_INLINE HitLanes chosen_hit(const Job& job, const PixelLanes& pixel, Mask lanes,
                               Float3& throughput) {
  const Integer across = integer(static_cast<int>(job.frame.extent.x));
  const Records records(job.chosen, hn::Add(hn::Mul(pixel.y, across), pixel.x),
                        sizeof(shared::Hit) / 4);
  const Float4 front = records.four(0), back = records.four(4);
  const Float weight = gathered4(job.transmittance, pixel).w;
  throughput = Float3{back.y, back.z, back.w} * (gathered_last(job.radiance, pixel) / weight);
  HitLanes hit;
  hit.met = lanes;
  hit.t = front.x;
  hit.instance = as_integer(front.y);
  hit.triangle = as_integer(front.z);
  hit.u = front.w;
  hit.v = back.x;
  return hit;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
