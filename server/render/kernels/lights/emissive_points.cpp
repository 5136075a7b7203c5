#include "render/kernels/lights/emissive_points.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/lights/emissive_points.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/emissive_lights.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/ray_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class EmissivePoints : RandomDigits<UnsignedTag> {
 public:
  explicit EmissivePoints(const EmissivePointsJob& job) : RandomDigits(unsigned_tag), job_(job) {}

  /// As many as there are lanes, or less before `last`.
  HWY_INLINE void draw(int first, int last) const {
    HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> x{}, y{}, z{}, w{};
    for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane) {
      const auto index = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(lane);
      const glm::uvec3 one = hashed(index, 0), other = hashed(index, 1);
      x[lane] =
          (static_cast<float>(index) + digits(one.x)) / static_cast<float>(shared::emissive_points);
      y[lane] = digits(one.y), z[lane] = digits(other.x), w[lane] = digits(other.y);
    }
    const auto load = [](const auto& values) HWY_ATTR { return hn::Load(tag, values.data()); };
    const HitLanes drawn = draw_emissive(job_.scene, {load(x), load(y)}, {load(z), load(w)});
    const EmissiveLanes at = seen_from(drawn, numbers(0.0f));
    const Float3 front = seen_from(drawn, at.position + at.normal).emission;
    const Float3 back = seen_from(drawn, at.position - at.normal).emission;
    const Float brightest = hn::Max(back.x, hn::Max(back.y, back.z));
    store(first, last, {at.position.x, at.position.y, at.position.z, at.density},
          {at.normal.x, at.normal.y, at.normal.z,
           hn::IfThenElseZero(hn::Gt(brightest, zero()), number(1.0f))},
          {front.x, front.y, front.z, zero()});
  }

 private:
  glm::uvec3 hashed(std::uint32_t index, std::uint32_t which) const {
    return pcg3d({index, job_.frame.sample_index, job_.frame.seed * 2u + which});
  }
  static float digits(std::uint32_t word) { return static_cast<float>(word >> 8u) * 0x1p-24f; }

  HWY_NOINLINE EmissiveLanes seen_from(const HitLanes& drawn, const Float3& receiver) const {
    return emissive_sample<true>(job_.scene, drawn, receiver, zero(), zero());
  }

  HWY_INLINE void store(int first, int last, const Float4& place, const Float4& facing,
                        const Float4& emission) const {
    constexpr std::size_t most = 4 * hn::MaxLanes(Tag());
    HWY_ALIGN std::array<float, most> a, b, c;
    hn::StoreInterleaved4(place.x, place.y, place.z, place.w, tag, a.data());
    hn::StoreInterleaved4(facing.x, facing.y, facing.z, facing.w, tag, b.data());
    hn::StoreInterleaved4(emission.x, emission.y, emission.z, emission.w, tag, c.data());
    const int count = std::min(static_cast<int>(hn::Lanes(tag)), last - first);
    for (int lane = 0; lane < count; ++lane) {
      auto* const out = reinterpret_cast<std::byte*>(job_.points.data + first + lane);
      std::memcpy(out, &a[4 * static_cast<std::size_t>(lane)], 16);
      std::memcpy(out + 16, &b[4 * static_cast<std::size_t>(lane)], 16);
      std::memcpy(out + 32, &c[4 * static_cast<std::size_t>(lane)], 16);
    }
  }

  const EmissivePointsJob& job_;
};

void draw_points(const EmissivePointsJob& job, int first, int last) {
  const EmissivePoints points(job);
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) points.draw(i, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(draw_points);

void emissive_points(const EmissivePointsJob& job) {
  for_each_batch(shared::emissive_points, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(draw_points)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
