// Choosing one of the frame's points of emissive triangles, and the balance with gathering rays:
// shaders/lib/lighting/emissive_choice.glsl and emissive_balance.glsl in vectors. Included once per
// instruction set.
#if defined(HELIOGRAPH_KERNELS_EMISSIVE_CHOICE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_EMISSIVE_CHOICE_HPP
#undef HELIOGRAPH_KERNELS_EMISSIVE_CHOICE_HPP
#else
#define HELIOGRAPH_KERNELS_EMISSIVE_CHOICE_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/rays.hpp"
#include "render/kernels/simd/two_sided_light.hpp"
#include "shaders/shared/emissive.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr auto emissive_candidates_per_receiver =
    static_cast<float>(shared::emissive_candidates);

/// The fraction of a point's emission that receivers get of it.
HWY_INLINE Float emissive_share(Float density, Float cosine_by_pi, Float cosine_there,
                                Float away_squared) {
  const Float receiving = cosine_by_pi * cosine_there;
  const Float sending = number(emissive_candidates_per_receiver) * density * away_squared;
  return receiving / at_least(receiving + sending, 1e-30f);
}

/// The fraction of emission that is left to rays of the density `gathered`.
HWY_INLINE Float gathered_share(Float gathered, Float sampled) {
  const Float both = hn::MulAdd(number(emissive_candidates_per_receiver), sampled, gathered);
  return gathered / at_least(both, 1e-30f);
}

struct EmissiveChoice {
  Float3 light;      // irradiance / pi, unshadowed, as one sample of all points
  Float total;       // its luminance; 0: there is none
  Float3 direction;  // toward the point
  Float distance;
};

/// `points`: shared::emissive_points of them. `start` in [0, 1) says which are weighed; `pick`
/// decides. `sides`: factors on the light of both sides of receivers; none: they get light from one
/// only.
HWY_INLINE EmissiveChoice choose_emissive(const shared::EmissivePoint* points,
                                          const Float3& position, const Float3& normal,
                                          const Float3& geometric, Float start, Float pick,
                                          const SideShares* sides = nullptr) {
  static_assert(sizeof(shared::EmissivePoint) == 48);
  constexpr auto count = static_cast<int>(shared::emissive_points);
  constexpr int step = count / static_cast<int>(shared::emissive_candidates);
  static_assert((count & (count - 1)) == 0);
  EmissiveChoice choice{numbers(0.0f), zero(), normal, zero()};
  Float chosen_weight = one();
  const Integer first = truncated(start * number(static_cast<float>(count)));
  for (int i = 0; i < static_cast<int>(shared::emissive_candidates); ++i) {
    const Integer index = hn::And(hn::Add(first, integer(i * step)), integer(count - 1));
    const Records point(points, index, sizeof(shared::EmissivePoint) / 4);
    const Float4 place = point.four(0), facing = point.four(4);
    const Float3 way = Float3{place.x, place.y, place.z} - position;
    const Float squared = at_least(dot(way, way), 1e-20f);
    const Float3 direction = way * reciprocal_sqrt(squared);
    Float there = hn::Neg(dot(Float3{facing.x, facing.y, facing.z}, direction));
    there = select(hn::Gt(facing.w, zero()), hn::Abs(there), there);
    Float here = cosine_density(dot(normal, direction)), above = dot(geometric, direction);
    Mask behind = hn::Lt(one(), zero());
    if (sides) {
      behind = hn::And(hn::Lt(above, zero()), hn::Gt(largest_of(sides->behind), zero()));
      here = select(behind, hn::Neg(here), here);
      above = select(behind, hn::Neg(above), above);
    }
    const Float least = hn::Min(hn::Min(here, there), above);
    const Mask seen = hn::And(hn::Gt(place.w, zero()), hn::Gt(least, zero()));
    if (none(seen)) continue;
    Float3 light = point.triple(8) * emissive_share(place.w, here, there, squared);
    if (sides) light = light * select(behind, sides->behind, sides->near);
    const Float weight = hn::IfThenElseZero(seen, luminance(light));
    const Mask shines = hn::Gt(weight, zero());
    choice.total = choice.total + weight;
    const Float probability = weight / select(shines, choice.total, one());
    const Mask chosen = hn::And(shines, hn::Lt(pick, probability));
    const Float remaining = (pick - probability) / (one() - probability);
    pick = select(chosen, pick / probability, select(shines, remaining, pick));
    chosen_weight = select(chosen, weight, chosen_weight);
    choice.light = select(chosen, light, choice.light);
    choice.direction = select(chosen, direction, choice.direction);
    choice.distance = select(chosen, squared, choice.distance);
  }
  choice.light = choice.light * (choice.total / chosen_weight);
  choice.distance = hn::Sqrt(choice.distance);
  return choice;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
