// The random numbers of shaders/lib/math/random.glsl in vectors; included once per instruction set.
// Portable SIMD by Google Highway; the guard is its convention for such headers.
#if defined(HELIOGRAPH_KERNELS_RANDOM_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_RANDOM_HPP
#undef HELIOGRAPH_KERNELS_RANDOM_HPP
#else
#define HELIOGRAPH_KERNELS_RANDOM_HPP
#endif

#include <cstdint>
#include <glm/glm.hpp>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What the numbers of all dimensions are made with.
template <class DU>
class RandomDigits {
 protected:
  using V = hn::Vec<DU>;
  using F = hn::Vec<hn::RebindToFloat<DU>>;

  HWY_INLINE explicit RandomDigits(DU du) : du_(du) {}

  static glm::uvec3 pcg3d(glm::uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
  }
  HWY_INLINE V times(V v, std::uint32_t factor) const { return hn::Mul(v, hn::Set(du_, factor)); }
  /// Swaps every second run of bits with the next.
  template <int bits>
  HWY_INLINE V swap(V v, std::uint32_t mask) const {
    const V m = hn::Set(du_, mask);
    return hn::Or(hn::And(hn::ShiftRight<bits>(v), m), hn::ShiftLeft<bits>(hn::And(v, m)));
  }
  HWY_INLINE V reverse(V v) const {
    v = swap<1>(v, 0x55555555u);
    v = swap<2>(v, 0x33333333u);
    v = swap<4>(v, 0x0f0f0f0fu);
    v = swap<8>(v, 0x00ff00ffu);
    return hn::Or(hn::ShiftRight<16>(v), hn::ShiftLeft<16>(v));
  }
  HWY_INLINE V scramble_upward(V v, std::uint32_t seed) const {
    v = hn::Xor(v, times(v, 0x3d20adeau));
    v = times(hn::Add(v, hn::Set(du_, seed)), (seed >> 16u) | 1u);
    v = hn::Xor(v, times(v, 0x05526c56u));
    return hn::Xor(v, times(v, 0x53a22864u));
  }
  HWY_INLINE V shuffle(V v, std::uint32_t seed) const {
    return reverse(scramble_upward(reverse(v), seed));
  }
  template <int bits>
  HWY_INLINE V fold(V v, std::uint32_t mask) const {
    return hn::Xor(v, hn::And(hn::ShiftRight<bits>(v), hn::Set(du_, mask)));
  }
  HWY_INLINE V sobol_second(V v) const {
    v = fold<1>(v, 0x55555555u);
    v = fold<2>(v, 0x33333333u);
    v = fold<4>(v, 0x0f0f0f0fu);
    v = fold<8>(v, 0x00ff00ffu);
    return hn::Xor(v, hn::ShiftRight<16>(v));
  }
  template <int bits>
  HWY_INLINE V part(V v, std::uint32_t mask) const {
    return hn::And(hn::Or(v, hn::ShiftLeft<bits>(v)), hn::Set(du_, mask));
  }
  HWY_INLINE V spread(V v) const {
    v = hn::And(v, hn::Set(du_, 0xffffu));
    v = part<8>(v, 0x00ff00ffu);
    v = part<4>(v, 0x0f0f0f0fu);
    v = part<2>(v, 0x33333333u);
    return part<1>(v, 0x55555555u);
  }
  HWY_INLINE F unit_interval(V digits) const {
    const hn::RebindToFloat<DU> df;
    const hn::RebindToSigned<DU> di;
    const auto whole = hn::BitCast(di, hn::ShiftRight<8>(reverse(digits)));
    return hn::Mul(hn::ConvertTo(df, whole), hn::Set(df, 0x1p-24f));
  }

  /// A pixel's index in the quadtree.
  HWY_INLINE V order(V x, V y) const { return hn::Or(spread(x), hn::ShiftLeft<1>(spread(y))); }

  DU du_;
};

/// Two numbers of one sample, dimension and seed, for any pixel.
template <class DU>
class RandomPairs : RandomDigits<DU> {
  using Base = RandomDigits<DU>;
  using typename Base::F;
  using typename Base::V;

 public:
  HWY_INLINE RandomPairs(DU du, std::uint32_t sample, std::uint32_t dimension, std::uint32_t seed)
      : Base(du),
        keys_(Base::pcg3d({dimension, seed, 0})),
        more_(Base::pcg3d({dimension, seed, 1})) {
    const V index = this->shuffle(hn::Set(du, sample), keys_.y);
    first_ = this->scramble_upward(index, more_.x);
    second_ = this->scramble_upward(this->sobol_second(index), more_.z);
  }

  /// Both numbers in [0, 1).
  HWY_INLINE void at(V x, V y, F& a, F& b) const {
    const V index = this->shuffle(this->order(x, y), keys_.x);
    a = this->unit_interval(hn::Xor(this->scramble_upward(index, keys_.z), first_));
    const V second = this->scramble_upward(this->sobol_second(index), more_.y);
    b = this->unit_interval(hn::Xor(second, second_));
  }
  /// Of pixels in one row.
  HWY_INLINE void at(V x, std::uint32_t y, F& a, F& b) const { at(x, hn::Set(this->du_, y), a, b); }

 private:
  glm::uvec3 keys_;
  glm::uvec3 more_;
  V first_;
  V second_;
};

/// One number, independent of the pairs of every dimension.
template <class DU>
class RandomNumbers : RandomDigits<DU> {
  using Base = RandomDigits<DU>;
  using typename Base::F;
  using typename Base::V;

 public:
  HWY_INLINE RandomNumbers(DU du, std::uint32_t sample, std::uint32_t dimension, std::uint32_t seed)
      : Base(du), keys_(Base::pcg3d({dimension, seed, 2})) {
    const V index = this->shuffle(hn::Set(du, sample), keys_.y);
    of_sample_ = this->scramble_upward(index, keys_.x ^ keys_.y);
  }

  HWY_INLINE F at(V x, V y) const {
    const V index = this->shuffle(this->order(x, y), keys_.x);
    return this->unit_interval(hn::Xor(this->scramble_upward(index, keys_.z), of_sample_));
  }

 private:
  glm::uvec3 keys_;
  V of_sample_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
