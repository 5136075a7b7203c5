// What host kernels share: pixels of mapped images in vectors, whose lanes lie side by side in a
// row. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_PIXELS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PIXELS_HPP
#undef HELIOGRAPH_KERNELS_PIXELS_HPP
#else
#define HELIOGRAPH_KERNELS_PIXELS_HPP
#endif

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "gpu/memory/image.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Pair {
  V x, y;
};
template <class V>
struct Triple {
  V x, y, z;
};
template <class V>
struct Quad {
  V x, y, z, w;
};

/// 1 / v, to 24 bits.
template <class V>
HWY_INLINE V reciprocal(V v) {
  const V guess = hn::ApproximateReciprocal(v);
  return hn::Mul(guess, hn::NegMulAdd(v, guess, hn::Set(hn::DFromV<V>(), 2.0f)));
}

/// 1 / sqrt(v), to 23 bits.
template <class V>
HWY_INLINE V reciprocal_sqrt(V v) {
  const hn::DFromV<V> d;
  const V guess = hn::ApproximateReciprocalSqrt(v);
  const V half = hn::Mul(hn::Mul(v, hn::Set(d, 0.5f)), guess);
  return hn::Mul(guess, hn::NegMulAdd(half, guess, hn::Set(d, 1.5f)));
}

template <class V>
HWY_INLINE Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
HWY_INLINE Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
HWY_INLINE Triple<V> operator-(const Triple<V>& v) {
  return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}
template <class V>
HWY_INLINE Triple<V> operator*(const Triple<V>& a, const Triple<V>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class V>
HWY_INLINE Triple<V> operator*(const Triple<V>& a, V b) {
  return {a.x * b, a.y * b, a.z * b};
}
template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
template <class V>
HWY_INLINE V length(const Triple<V>& a) {
  return hn::Sqrt(dot(a, a));
}
template <class V>
HWY_INLINE Triple<V> cross_of(const Triple<V>& a, const Triple<V>& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z),
          hn::MulSub(a.x, b.y, a.y * b.x)};
}
template <class V>
HWY_INLINE Triple<V> normalized(const Triple<V>& a) {
  return a * (hn::Set(hn::DFromV<V>(), 1.0f) / length(a));
}
template <class V>
HWY_INLINE V squared_distance(const Triple<V>& a, const Triple<V>& b) {
  const Triple<V> apart = a - b;
  return dot(apart, apart);
}

/// `a` where `mask`, otherwise `b`.
template <class M, class V>
HWY_INLINE Triple<V> select(M mask, const Triple<V>& a, const Triple<V>& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
          hn::IfThenElse(mask, a.z, b.z)};
}
template <class M, class V>
HWY_INLINE Quad<V> select(M mask, const Quad<V>& a, const Quad<V>& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
          hn::IfThenElse(mask, a.z, b.z), hn::IfThenElse(mask, a.w, b.w)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> splat(D d, const glm::vec3& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

template <class V>
HWY_INLINE V clamped(V v, float low, float high) {
  const hn::DFromV<V> d;
  return hn::Min(hn::Max(v, hn::Set(d, low)), hn::Set(d, high));
}

template <class V>
HWY_INLINE V mix(V a, V b, V fraction) {
  return hn::MulAdd(b - a, fraction, a);
}
template <class V>
HWY_INLINE Triple<V> mix(const Triple<V>& a, const Triple<V>& b, V fraction) {
  return {mix(a.x, b.x, fraction), mix(a.y, b.y, fraction), mix(a.z, b.z, fraction)};
}

template <class V>
HWY_INLINE V luminance(const Triple<V>& c) {
  const hn::DFromV<V> d;
  return hn::MulAdd(c.x, hn::Set(d, 0.2126f),
                    hn::MulAdd(c.y, hn::Set(d, 0.7152f), c.z * hn::Set(d, 0.0722f)));
}

/// shaders/lib/math/octahedral.glsl
template <class V>
HWY_INLINE Triple<V> octahedral_decode(V x, V y) {
  const hn::DFromV<V> d;
  const V z = hn::Set(d, 1.0f) - hn::Abs(x) - hn::Abs(y);
  const V below = hn::Max(hn::Neg(z), hn::Zero(d));
  const Triple<V> n{x - hn::CopySignToAbs(below, x), y - hn::CopySignToAbs(below, y), z};
  return n * reciprocal_sqrt(dot(n, n));
}

/// Numbers that are none: NaN and infinities of either sign.
template <class V>
HWY_INLINE hn::Mask<hn::DFromV<V>> is_bad(V v) {
  const hn::DFromV<V> d;
  // Written so that a comparison with NaN counts as bad.
  return hn::Not(hn::Le(hn::Abs(v), hn::Set(d, 3.4028235e38f)));
}
template <class V>
HWY_INLINE hn::Mask<hn::DFromV<V>> is_bad(const Triple<V>& v) {
  return hn::Or(is_bad(v.x), hn::Or(is_bad(v.y), is_bad(v.z)));
}

/// The first texel of row `y`.
template <class Texel>
HWY_INLINE Texel* row_of(const gpu::HostView& image, int y) {
  return image.row<Texel>(static_cast<std::uint32_t>(y));
}

/// Four channels of texels side by side, the first at `from`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Quad<V> load4(D d, const float* from) {
  Quad<V> t;
  hn::LoadInterleaved4(d, from, t.x, t.y, t.z, t.w);
  return t;
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store4(D d, const Quad<V>& t, float* to) {
  hn::StoreInterleaved4(t.x, t.y, t.z, t.w, d, to);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Pair<V> load2(D d, const float* from) {
  Pair<V> t;
  hn::LoadInterleaved2(d, from, t.x, t.y);
  return t;
}
/// Four channels of texels anywhere; `index` counts floats.
template <class D, class V = hn::Vec<D>, class VI = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE Quad<V> gather4(D d, const float* image, VI index) {
  return {hn::GatherIndex(d, image, index), hn::GatherIndex(d, image + 1, index),
          hn::GatherIndex(d, image + 2, index), hn::GatherIndex(d, image + 3, index)};
}
template <class D, class V = hn::Vec<D>, class VI = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE Triple<V> gather3(D d, const float* image, VI index) {
  return {hn::GatherIndex(d, image, index), hn::GatherIndex(d, image + 1, index),
          hn::GatherIndex(d, image + 2, index)};
}

/// An integer for every lane, in memory.
template <class D>
struct LaneIndices {
  using DI = hn::RebindToSigned<D>;
  HWY_ALIGN std::array<int, hn::MaxLanes(D())> of;
  LaneIndices() = default;
  HWY_INLINE explicit LaneIndices(hn::Vec<DI> index) { hn::Store(index, DI(), of.data()); }
};

#if HWY_TARGET != HWY_SCALAR
/// Vectors of 128 bits side by side: those of every fourth lane from `first` on.
template <class D, class Load>
HWY_INLINE hn::Vec<D> every_fourth(D d, const Load& load, std::size_t first) {
  if constexpr (hn::MaxLanes(D()) <= 4) {
    return load(first);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, every_fourth(half, load, first + hn::MaxLanes(half)),
                       every_fourth(half, load, first));
  }
}

/// The first to fourth numbers of the vectors that `load(lane)` gives.
template <class D, class Load, class V = hn::Vec<D>>
HWY_INLINE Quad<V> transposed(D d, const Load& load) {
  const V a = every_fourth(d, load, 0), b = every_fourth(d, load, 1);
  const V c = every_fourth(d, load, 2), e = every_fourth(d, load, 3);
  const hn::Repartition<std::uint64_t, D> pairs;
  const auto low_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
  const auto low_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto high_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
  const auto high_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low_ab, low_ce)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, low_ab, low_ce)),
          hn::BitCast(d, hn::InterleaveLower(pairs, high_ab, high_ce)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, high_ab, high_ce))};
}
#endif

/// Four words for every lane: `front(lane)` points at the first two, `back(lane)` at the others.
/// Much faster than gathers, which take a load and more for every word of every lane.
template <class D, class Front, class Back, class V = hn::Vec<D>>
HWY_INLINE Quad<V> two_and_two_words(D d, const Front& front, const Back& back) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) >= 4) {
    const auto load = [&](std::size_t lane) HWY_ATTR {
      const hn::Full64<float> pair;
      return hn::Combine(hn::Full128<float>(), hn::LoadU(pair, back(lane)),
                         hn::LoadU(pair, front(lane)));
    };
    return transposed(d, load);
  }
#endif
  return {hn::Set(d, front(0)[0]), hn::Set(d, front(0)[1]), hn::Set(d, back(0)[0]),
          hn::Set(d, back(0)[1])};
}

/// Four words for every lane, which lie at `from(lane)`.
template <class D, class From, class V = hn::Vec<D>>
HWY_INLINE Quad<V> four_words(D d, const From& from) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) >= 4) {
    const auto load = [&](std::size_t lane)
                          HWY_ATTR { return hn::LoadU(hn::Full128<float>(), from(lane)); };
    return transposed(d, load);
  }
#endif
  return {hn::Set(d, from(0)[0]), hn::Set(d, from(0)[1]), hn::Set(d, from(0)[2]),
          hn::Set(d, from(0)[3])};
}

/// Channel `shift` / 8 of rgba8 texels, 0..1.
template <int shift, class D, class VU>
HWY_INLINE hn::Vec<D> unorm8(D d, VU texels) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const auto byte = hn::And(hn::ShiftRight<shift>(texels), hn::Set(du, 0xffu));
  return hn::ConvertTo(d, hn::BitCast(di, byte)) * hn::Set(d, 1.0f / 255.0f);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Quad<V> load_unorm8(D d, const std::uint32_t* from) {
  const auto texels = hn::LoadU(hn::RebindToUnsigned<D>(), from);
  return {unorm8<0>(d, texels), unorm8<8>(d, texels), unorm8<16>(d, texels), unorm8<24>(d, texels)};
}

/// A half float in the lower 16 bits of each lane.
template <class D, class VU>
HWY_INLINE hn::Vec<D> half_float(D d, VU bits) {
  const hn::RebindToUnsigned<D> du;
  const auto magnitude = hn::ShiftLeft<13>(hn::And(bits, hn::Set(du, 0x7fffu)));
  const auto sign = hn::ShiftLeft<16>(hn::And(bits, hn::Set(du, 0x8000u)));
  const auto finite = hn::BitCast(d, magnitude) * hn::Set(d, 0x1p112f);
  const auto endless = hn::BitCast(d, hn::Or(magnitude, hn::Set(du, 0x7f800000u)));
  const auto size = hn::IfThenElse(hn::Lt(finite, hn::Set(d, 65536.0f)), finite, endless);
  return hn::Or(size, hn::BitCast(d, sign));
}
/// The first three channels of rgba16f texels side by side.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> load_half3(D d, const std::uint32_t* from) {
  const hn::RebindToUnsigned<D> du;
  hn::Vec<decltype(du)> xy, zw;
  hn::LoadInterleaved2(du, from, xy, zw);
  return {half_float(d, xy), half_float(d, hn::ShiftRight<16>(xy)), half_float(d, zw)};
}

/// Four halves of texels side by side.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Quad<V> load_half4(D d, const std::uint32_t* from) {
  const hn::RebindToUnsigned<D> du;
  hn::Vec<decltype(du)> xy, zw;
  hn::LoadInterleaved2(du, from, xy, zw);
  return {half_float(d, xy), half_float(d, hn::ShiftRight<16>(xy)), half_float(d, zw),
          half_float(d, hn::ShiftRight<16>(zw))};
}

/// Rounds to the nearest halves; values must be at most 65504.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_half4(D, const Quad<V>& t, std::uint32_t* to) {
  const hn::RebindToUnsigned<D> du;
  const hn::Rebind<hwy::float16_t, D> halves;
  const hn::Rebind<std::uint16_t, D> words;
  const auto word = [&](V v) HWY_ATTR {
    return hn::PromoteTo(du, hn::BitCast(words, hn::DemoteTo(halves, v)));
  };
  const auto xy = hn::Or(word(t.x), hn::ShiftLeft<16>(word(t.y)));
  const auto zw = hn::Or(word(t.z), hn::ShiftLeft<16>(word(t.w)));
  hn::StoreInterleaved2(xy, zw, du, to);
}

/// Lanes at or right of `start` of those that begin at `x`: the last block of a row reaches back
/// over pixels that are done.
template <class D>
HWY_INLINE hn::Mask<D> from_column(D d, int x, int start) {
  return hn::Ge(hn::Iota(d, static_cast<float>(x)), hn::Set(d, static_cast<float>(start)));
}

/// Runs `Kernel<tag>(job).rows(first, last)` in the widest vectors that fit into a row.
template <template <class> class Kernel, class Job>
HWY_INLINE void run_rows(const Job& job, int width, int first, int last) {
  using Wide = hn::ScalableTag<float>;
  if (static_cast<std::size_t>(width) >= hn::Lanes(Wide())) {
    Kernel<Wide>(job).rows(first, last);
  } else {
    Kernel<hn::FixedTag<float, 1>>(job).rows(first, last);
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
