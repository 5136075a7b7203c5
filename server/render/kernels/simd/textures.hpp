// The texture heap as shaders/lib/scene/texture_heap.glsl reads it, a lane for every surface.
// Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_TEXTURES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TEXTURES_HPP
#undef HELIOGRAPH_KERNELS_TEXTURES_HPP
#else
#define HELIOGRAPH_KERNELS_TEXTURES_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/resources/host_tables.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// IEC 61966-2-1 by the polynomial of texture_heap.glsl.
HWY_INLINE Float srgb_decode(Float e) {
  const Float cubic = hn::MulAdd(number(-0.1561215f), e, number(0.6158348f));
  return hn::Mul(e, hn::MulAdd(e, hn::MulAdd(e, cubic, number(0.4940478f)), number(0.0457505f)));
}

/// Where one axis of an image is read: the texels on both sides and the second one's weight.
struct Neighbours {
  Integer low, high;
  Float fraction;
};

/// Folds a coordinate into the image first: wrapping then concerns the outermost texels alone.
HWY_INLINE Neighbours neighbours(Float coordinate, Integer size, Integer wrap, Mask nearest) {
  const Mask repeats = float_mask(hn::Eq(wrap, integer(shared::wrap_repeat)));
  Float at = clamped(coordinate, 0.0f, 1.0f);
  const Float repeated = hn::Sub(coordinate, hn::Floor(coordinate));
  at = select(repeats, repeated, at);
  const Mask mirrored = float_mask(hn::Eq(wrap, integer(shared::wrap_mirror)));
  if (!none(mirrored)) {
    const Float half = hn::Mul(number(0.5f), coordinate);
    const Float there_and_back = hn::Mul(number(2.0f), hn::Sub(half, hn::Floor(half)));
    at = select(mirrored, hn::Min(there_and_back, hn::Sub(number(2.0f), there_and_back)), at);
  }
  const Float middle = hn::IfThenElse(nearest, zero(), number(0.5f));
  at = hn::Sub(hn::Mul(at, to_float(size)), middle);
  const Float corner = hn::Floor(at);
  const Integer last = hn::Sub(size, integer(1));
  const auto wrapped = [&](Integer texel) {
    const Mask before = float_mask(hn::Lt(texel, integer(0)));
    const Mask behind = float_mask(hn::Gt(texel, last));
    texel = select(before, select(repeats, last, integer(0)), texel);
    return select(behind, select(repeats, integer(0), last), texel);
  };
  const Integer low = truncated(corner);
  return {wrapped(low), wrapped(hn::Add(low, integer(1))),
          hn::IfThenElse(nearest, zero(), hn::Sub(at, corner))};
}

/// One texel, decoded.
HWY_INLINE Float4 heap_texel(const std::uint32_t* texels, Integer index, Mask srgb) {
  const Integer packed = gather(texels, index);
  Float4 color = unpack_unorm8(packed);
  if (!none(srgb)) {
    color.x = select(srgb, srgb_decode(color.x), color.x);
    color.y = select(srgb, srgb_decode(color.y), color.y);
    color.z = select(srgb, srgb_decode(color.z), color.z);
  }
  return color;
}

HWY_INLINE Float4 mix(const Float4& a, const Float4& b, Float fraction) {
  return {mix(a.x, b.x, fraction), mix(a.y, b.y, fraction), mix(a.z, b.z, fraction),
          mix(a.w, b.w, fraction)};
}

/// What a slot's lanes read.
struct TextureLanes {
  Integer width, height, wrap_s, wrap_t, flags, levels, first_level;
  Mask used;  // the others read the heap's first texel
};

HWY_INLINE Float4 sample_level(const SceneView& scene, const TextureLanes& t, Integer level,
                               const Float2& uv, Mask nearest, Mask srgb) {
  const Integer width = hn::Max(hn::Shr(t.width, level), integer(1));
  const Integer height = hn::Max(hn::Shr(t.height, level), integer(1));
  const Integer first =
      hn::IfThenElseZero(integer_mask(t.used), gather(scene.levels, hn::Add(t.first_level, level)));
  const Neighbours s = neighbours(uv.x, width, t.wrap_s, nearest);
  const Neighbours r = neighbours(uv.y, height, t.wrap_t, nearest);
  const Integer top = hn::Add(first, hn::Mul(r.low, width));
  const Integer bottom = hn::Add(first, hn::Mul(r.high, width));
  const auto texel = [&](Integer row, Integer column) {
    return heap_texel(scene.texels, hn::Add(row, column), srgb);
  };
  return mix(mix(texel(top, s.low), texel(top, s.high), s.fraction),
             mix(texel(bottom, s.low), texel(bottom, s.high), s.fraction), r.fraction);
}

/// `lod` counts from the largest level. Where `one_level`, only the nearest is read.
template <bool one_level>
HWY_INLINE Float4 sample_texture(const SceneView& scene, const TextureLanes& t, const Float2& uv,
                                 Float lod) {
  const auto flag = [&](std::uint32_t bit) {
    const Integer requested = integer(static_cast<int>(bit));
    return float_mask(hn::Eq(hn::And(t.flags, requested), requested));
  };
  const Mask srgb = flag(shared::texture_srgb);
  const Mask magnified = hn::Le(lod, zero());
  Mask nearest = hn::Or(hn::And(magnified, flag(shared::texture_magnify_nearest)),
                        hn::AndNot(magnified, flag(shared::texture_minify_nearest)));
  const Float last = to_float(hn::Sub(t.levels, integer(1)));
  lod = hn::Min(hn::Max(lod, zero()), last);
  const Float half = number(0.5f);
  const Float whole = hn::Max(hn::Sub(hn::Ceil(hn::Add(lod, half)), one()), zero());
  lod = select(flag(shared::texture_levels_nearest), whole, lod);
  if constexpr (one_level) {
    return sample_level(scene, t, truncated(hn::Add(lod, half)), uv, nearest, srgb);
  }
  const Float finer = hn::Floor(lod);
  const Integer level = truncated(finer);
  const Float fraction = hn::Sub(lod, finer);
  const Float4 near = sample_level(scene, t, level, uv, nearest, srgb);
  if (all(hn::Eq(fraction, zero()))) return near;
  const Integer coarser = hn::Min(hn::Add(level, integer(1)), hn::Sub(t.levels, integer(1)));
  return mix(near, sample_level(scene, t, coarser, uv, nearest, srgb), fraction);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
