// The G-buffer's layers: shaders/lib/scene/layers.glsl in vectors. Included once per instruction
// set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_PACKED_LAYER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PACKED_LAYER_HPP
#undef HELIOGRAPH_KERNELS_PACKED_LAYER_HPP
#else
#define HELIOGRAPH_KERNELS_PACKED_LAYER_HPP
#endif

#include "render/kernels/simd/material/layers.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr std::uint32_t packed_grain = 1u << 30u;
inline constexpr std::uint32_t packed_tint = 1u << 31u;

/// storage_basis() of shaders/lib/math/geometry.glsl
template <class V>
HWY_INLINE void storage_basis(const Triple<V>& n, Triple<V>& tangent, Triple<V>& bitangent) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V s = hn::IfThenElse(hn::Ge(n.z, hn::Set(d, -0.999f)), one, hn::Set(d, -1.0f));
  const V a = hn::Neg(one / (s + n.z));
  const V b = n.x * n.y * a;
  tangent = {hn::MulAdd(s * n.x * n.x, a, one), s * b, hn::Neg(s * n.x)};
  bitangent = {b, hn::MulAdd(n.y * n.y, a, s), hn::Neg(n.y)};
}

/// decode_grain() of shaders/lib/scene/layers.glsl
template <class V>
HWY_INLINE Triple<V> decode_grain(V share, const Triple<V>& normal) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  Triple<V> tangent, bitangent;
  storage_basis(normal, tangent, bitangent);
  const V y = hn::MulSub(share, hn::Set(d, 2.0f), one);
  return normalized(tangent * (one - hn::Abs(y)) + bitangent * y);
}

/// unpack_layer() of texels of the G-buffer's layers, and unpack_tint(). `diffuse_transmission`:
/// what the surface image has of it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfaceLayer<V> unpack_layer(D d, const Quad<V>& texels, const Triple<V>& normal,
                                        V diffuse_transmission, V& roughness) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const auto bits = [du](V word) HWY_ATTR { return hn::BitCast(du, word); };
  const auto tenth = [&](auto shifted) HWY_ATTR {
    const V root = hn::ConvertTo(d, hn::BitCast(di, hn::And(shifted, hn::Set(du, 1023u)))) *
                   hn::Set(d, 1.0f / 1023.0f);
    return root * root;
  };
  const auto f0 = bits(texels.x), coat = bits(texels.z), sheen = bits(texels.w);
  const auto snorm = [d](auto whole) HWY_ATTR {
    return hn::Max(hn::ConvertTo(d, whole) * hn::Set(d, 1.0f / 32767.0f), hn::Set(d, -1.0f));
  };
  const auto coat_normal = hn::BitCast(di, texels.y);
  SurfaceLayer<V> layer;
  layer.f0 = {tenth(f0), tenth(hn::ShiftRight<10>(f0)), tenth(hn::ShiftRight<20>(f0))};
  layer.f90 = unorm8<24>(d, coat);
  Pair<V> encoded{snorm(hn::ShiftRight<16>(hn::ShiftLeft<16>(coat_normal))),
                  snorm(hn::ShiftRight<16>(coat_normal))};
  layer.coat = unorm8<0>(d, coat);
  layer.coat_roughness = unorm8<8>(d, coat);
  roughness = unorm8<16>(d, coat);
  Triple<V> root{unorm8<0>(d, sheen), unorm8<8>(d, sheen), unorm8<16>(d, sheen)};
  layer.sheen_roughness = unorm8<24>(d, sheen);
  layer.grain = {hn::Set(d, 1.0f), hn::Zero(d), hn::Zero(d)};
  layer.anisotropy = hn::Zero(d);
  const auto flag = hn::Set(du, packed_grain);
  const auto grained = hn::RebindMask(d, hn::Eq(hn::And(f0, flag), flag));
  if (!hn::AllFalse(d, grained)) {
    const auto part = [&](auto shifted, std::uint32_t most, float scale) HWY_ATTR {
      const auto whole = hn::BitCast(di, hn::And(shifted, hn::Set(du, most)));
      return hn::ConvertTo(d, whole) * hn::Set(d, scale);
    };
    const auto both = bits(texels.y);
    const V one = hn::Set(d, 1.0f);
    const Pair<V> coarse{part(both, 4095, 2.0f / 4094.0f) - one,
                         part(hn::ShiftRight<12>(both), 4095, 2.0f / 4094.0f) - one};
    encoded = {hn::IfThenElse(grained, coarse.x, encoded.x),
               hn::IfThenElse(grained, coarse.y, encoded.y)};
    const auto sixth = [&](auto shifted) HWY_ATTR { return part(shifted, 63, 1.0f / 63.0f); };
    root = select(
        grained,
        Triple<V>{sixth(sheen), sixth(hn::ShiftRight<6>(sheen)), sixth(hn::ShiftRight<12>(sheen))},
        root);
    layer.sheen_roughness =
        hn::IfThenElse(grained, sixth(hn::ShiftRight<18>(sheen)), layer.sheen_roughness);
    layer.anisotropy = hn::IfThenElseZero(grained, unorm8<24>(d, both));
    layer.grain = select(grained, decode_grain(unorm8<24>(d, sheen), normal), layer.grain);
  }
  layer.coat_normal = octahedral_decode(encoded.x, encoded.y);
  const auto tint_flag = hn::Set(du, packed_tint);
  const auto tinted = hn::RebindMask(d, hn::Eq(hn::And(f0, tint_flag), tint_flag));
  layer.diffuse_transmission = hn::IfThenElseZero(tinted, diffuse_transmission);
  layer.diffuse_tint = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  if (!hn::AllFalse(d, tinted)) {
    const auto words = bits(texels.y);
    const Triple<V> tint{unorm8<0>(d, words), unorm8<8>(d, words), unorm8<16>(d, words)};
    layer.diffuse_tint = select(tinted, tint * tint, layer.diffuse_tint);
    layer.coat_normal = select(tinted, normal, layer.coat_normal);
  }
  layer.sheen = root * root;
  // A pixel of the G-buffer lets no light through.
  layer.transmission = hn::Zero(d);
  layer.transmitted = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  return layer;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
