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

/// A texel, decoded.
HWY_INLINE Float4 decoded(Integer packed, Mask srgb) {
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
  Integer width, height, wrap_s, wrap_t, flags, levels;
  HWY_INLINE Mask has(std::uint32_t flag) const {
    const Integer requested = integer(static_cast<int>(flag));
    return float_mask(hn::Eq(hn::And(flags, requested), requested));
  }
};

/// Where a texture is read: four texels, counted from the first of their level, of one level or
/// two.
struct TexturePlace {
  struct Level {
    Integer level;
    Integer top_left, top_right, bottom_left, bottom_right;
    Float across, down;  // weights of right and bottom
  };
  std::array<Level, 2> levels;
  int level_count;
  Float fraction;  // weight of the second level
};

/// `lod` counts from the largest level. Where `one_level`, only the nearest is read. Not inlined,
/// like all that surfaces call for each of their textures: the processor runs more slowly through
/// code that does not fit into its first cache.
template <bool one_level>
HWY_NOINLINE void place_texture(const TextureLanes& t, const Float2& uv, Float lod,
                                TexturePlace& place) {
  const Mask magnified = hn::Le(lod, zero());
  const Mask nearest = hn::Or(hn::And(magnified, t.has(shared::texture_magnify_nearest)),
                              hn::AndNot(magnified, t.has(shared::texture_minify_nearest)));
  const Float last = to_float(hn::Sub(t.levels, integer(1)));
  lod = hn::Min(hn::Max(lod, zero()), last);
  const Float half = number(0.5f);
  const Float whole = hn::Max(hn::Sub(hn::Ceil(hn::Add(lod, half)), one()), zero());
  lod = select(t.has(shared::texture_levels_nearest), whole, lod);
  const Float finer = one_level ? hn::Add(lod, half) : hn::Floor(lod);
  place.fraction = one_level ? zero() : hn::Sub(lod, finer);
  place.level_count = all(hn::Eq(place.fraction, zero())) ? 1 : 2;
  for (int i = 0; i < place.level_count; ++i) {
    TexturePlace::Level& to = place.levels[static_cast<std::size_t>(i)];
    to.level = hn::Add(truncated(finer), integer(i));
    if (i > 0) to.level = hn::Min(to.level, hn::Sub(t.levels, integer(1)));
    const Integer width = hn::Max(hn::Shr(t.width, to.level), integer(1));
    const Integer height = hn::Max(hn::Shr(t.height, to.level), integer(1));
    const Neighbours s = neighbours(uv.x, width, t.wrap_s, nearest);
    const Neighbours r = neighbours(uv.y, height, t.wrap_t, nearest);
    const Integer top = hn::Mul(r.low, width), bottom = hn::Mul(r.high, width);
    to.top_left = hn::Add(top, s.low);
    to.top_right = hn::Add(top, s.high);
    to.bottom_left = hn::Add(bottom, s.low);
    to.bottom_right = hn::Add(bottom, s.high);
    to.across = s.fraction;
    to.down = r.fraction;
  }
}

/// Four texels, packed. Two of a row lie side by side unless the image ends between them. Lanes
/// that are not `used` may get any texels.
struct FootprintLanes {
  Integer top_left, top_right, bottom_left, bottom_right;

  HWY_INLINE FootprintLanes(const std::uint32_t* texels, Integer first,
                            const TexturePlace::Level& at, hn::Mask<IntegerTag> used) {
    const auto apart = hn::And(used, hn::Ne(at.top_right, hn::Add(at.top_left, integer(1))));
    const auto index = [&](Integer texel)
                           HWY_ATTR { return hn::IfThenElseZero(used, hn::Add(first, texel)); };
    if (!hn::AllFalse(integer_tag, apart)) {
      top_left = gather(texels, index(at.top_left));
      top_right = gather(texels, index(at.top_right));
      bottom_left = gather(texels, index(at.bottom_left));
      bottom_right = gather(texels, index(at.bottom_right));
      return;
    }
    const LaneIndices<Tag> above(index(at.top_left)), below(index(at.bottom_left));
    const auto* const words = reinterpret_cast<const float*>(texels);
    const Float4 found = two_and_two_words(
        tag, [&](std::size_t lane) { return words + above.of[lane]; },
        [&](std::size_t lane) { return words + below.of[lane]; });
    top_left = as_integer(found.x);
    top_right = as_integer(found.y);
    bottom_left = as_integer(found.z);
    bottom_right = as_integer(found.w);
  }
};

/// The texture whose levels begin at `first_level` of SceneView::levels; lanes that are not `used`
/// read the heap's first texels.
HWY_NOINLINE inline void read_texture(const SceneView& scene, const TexturePlace& place,
                                      Integer first_level, Mask used, Mask srgb, Float4& color) {
  const auto lanes = integer_mask(used);
  for (int i = 0; i < place.level_count; ++i) {
    const TexturePlace::Level& at = place.levels[static_cast<std::size_t>(i)];
    const Integer level = hn::IfThenElseZero(lanes, hn::Add(first_level, at.level));
    const FootprintLanes f(scene.texels, gather(scene.levels, level), at, lanes);
    const Float4 found =
        mix(mix(decoded(f.top_left, srgb), decoded(f.top_right, srgb), at.across),
            mix(decoded(f.bottom_left, srgb), decoded(f.bottom_right, srgb), at.across), at.down);
    color = i == 0 ? found : mix(color, found, place.fraction);
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
