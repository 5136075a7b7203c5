// Scene-linear Rec. 709 to display-linear [0, 1] in vectors: shaders/lib/math/tone_map.glsl, which
// tells the sources. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TONE_MAP_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TONE_MAP_HPP
#undef HELIOGRAPH_KERNELS_TONE_MAP_HPP
#else
#define HELIOGRAPH_KERNELS_TONE_MAP_HPP
#endif

#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `matrix` x c
template <class V>
HWY_INLINE Triple<V> transformed(const glm::mat3& m, const Triple<V>& c) {
  const hn::DFromV<V> d;
  return {dot(splat(d, {m[0].x, m[1].x, m[2].x}), c), dot(splat(d, {m[0].y, m[1].y, m[2].y}), c),
          dot(splat(d, {m[0].z, m[1].z, m[2].z}), c)};
}

template <class V>
HWY_INLINE Triple<V> clamped(const Triple<V>& c, float low, float high) {
  return {clamped(c.x, low, high), clamped(c.y, low, high), clamped(c.z, low, high)};
}

/// c^exponent for c >= 0.
template <class V>
HWY_INLINE V power(V c, float exponent) {
  const hn::DFromV<V> d;
  const V safe = hn::Max(c, hn::Set(d, 1e-30f));
  return hn::IfThenElseZero(hn::Gt(c, hn::Zero(d)),
                            hn::Exp(d, hn::Log(d, safe) * hn::Set(d, exponent)));
}

template <class V>
HWY_INLINE Triple<V> tone_map_neutral(const Triple<V>& radiance) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  constexpr float start = 0.8f - 0.04f, rest = 1.0f - start;
  const V darkest = hn::Min(radiance.x, hn::Min(radiance.y, radiance.z));
  const V offset = hn::IfThenElse(hn::Lt(darkest, hn::Set(d, 0.08f)),
                                  hn::NegMulAdd(hn::Set(d, 6.25f) * darkest, darkest, darkest),
                                  hn::Set(d, 0.04f));
  const Triple<V> color = radiance - Triple<V>{offset, offset, offset};
  const V peak = hn::Max(color.x, hn::Max(color.y, color.z));
  const auto bright = hn::Ge(peak, hn::Set(d, start));
  if (hn::AllFalse(d, bright)) return color;
  const V new_peak = one - hn::Set(d, rest * rest) / (peak + hn::Set(d, rest - start));
  const V g = one - one / hn::MulAdd(hn::Set(d, 0.15f), peak - new_peak, one);
  const Triple<V> compressed =
      mix(color * (new_peak / peak), Triple<V>{new_peak, new_peak, new_peak}, g);
  return select(bright, compressed, color);
}

template <class V>
HWY_INLINE Triple<V> tone_map_aces(const Triple<V>& color) {
  const hn::DFromV<V> d;
  const glm::mat3 input(0.59719f, 0.07600f, 0.02840f, 0.35458f, 0.90834f, 0.13383f, 0.04823f,
                        0.01566f, 0.83777f);
  const glm::mat3 output(1.60475f, -0.10208f, -0.00327f, -0.53108f, 1.10813f, -0.07276f, -0.07367f,
                         -0.00605f, 1.07602f);
  const auto fitted = [d](V v) HWY_ATTR {
    const V top = hn::MulSub(v, v + hn::Set(d, 0.0245786f), hn::Set(d, 0.000090537f));
    const V bottom = hn::MulAdd(v, hn::MulAdd(hn::Set(d, 0.983729f), v, hn::Set(d, 0.4329510f)),
                                hn::Set(d, 0.238081f));
    return top / bottom;
  };
  const Triple<V> v = transformed(input, color * hn::Set(d, 1.0f / 0.6f));
  return clamped(transformed(output, Triple<V>{fitted(v.x), fitted(v.y), fitted(v.z)}), 0.0f, 1.0f);
}

template <class V>
HWY_INLINE Triple<V> tone_map_agx(const Triple<V>& color) {
  const hn::DFromV<V> d;
  const glm::mat3 inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f,
                        0.0784335999999992f, 0.878468636469772f, 0.0784336f, 0.0792237451477643f,
                        0.0791661274605434f, 0.879142973793104f);
  const glm::mat3 outset(1.19687900512017f, -0.0528968517574562f, -0.0529716355144438f,
                         -0.0980208811401368f, 1.15190312990417f, -0.0980434501171241f,
                         -0.0990297440797205f, -0.0989611768448433f, 1.15107367264116f);
  constexpr float darkest = -12.47393f, brightest = 4.026069f;
  const auto contrast = [d](V linear) HWY_ATTR {
    const V stops = clamped(hn::Log2(d, hn::Max(linear, hn::Set(d, 1e-10f))), darkest, brightest);
    const V v = (stops - hn::Set(d, darkest)) * hn::Set(d, 1.0f / (brightest - darkest));
    // The polynomial by Horner's rule, highest power first.
    V sum = hn::Set(d, 15.5f);
    for (const float coefficient : {-40.14f, 31.96f, -6.868f, 0.4298f, 0.1191f, -0.00232f}) {
      sum = hn::MulAdd(sum, v, hn::Set(d, coefficient));
    }
    return sum;
  };
  const Triple<V> v = transformed(inset, color);
  const Triple<V> shown =
      transformed(outset, Triple<V>{contrast(v.x), contrast(v.y), contrast(v.z)});
  return {power(shown.x, 2.2f), power(shown.y, 2.2f), power(shown.z, 2.2f)};
}

/// IEC 61966-2-1.
template <class V>
HWY_INLINE V srgb_encode(V linear) {
  const hn::DFromV<V> d;
  const V c = clamped(linear, 0.0f, 1.0f);
  const V curve = hn::MulSub(hn::Set(d, 1.055f), power(c, 1.0f / 2.4f), hn::Set(d, 0.055f));
  return hn::IfThenElse(hn::Le(c, hn::Set(d, 0.0031308f)), hn::Set(d, 12.92f) * c, curve);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
