// The texture slots of materials and their layers, a lane for every surface. Included once per
// instruction set.
#if defined(HELIOGRAPH_KERNELS_SLOTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SLOTS_HPP
#undef HELIOGRAPH_KERNELS_SLOTS_HPP
#else
#define HELIOGRAPH_KERNELS_SLOTS_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/material/textures.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Where textures are read: both uv sets, and the level of detail of an image of one texel.
struct LookupLanes {
  Float2 first, second;
  Float first_lod, second_lod;
};

/// Where the slots of a record begin.
template <class Record>
inline constexpr int first_slot = HELIOGRAPH_WORD(Material, base_color_slot);
template <>
inline constexpr int first_slot<Layer> = HELIOGRAPH_WORD(Layer, coat_slot);

/// The textures of each lane's record, a Material or a Layer. Most records' textures are read at
/// one place.
template <bool one_level, class Record>
class SlotReader {
 public:
  HWY_INLINE SlotReader(const SceneView& scene, const Records& record, const LookupLanes& lookup)
      : scene_(scene), record_(record), lookup_(lookup) {}

  /// Lanes in which the slot that begins at `word` has a texture.
  HWY_INLINE Mask used(int word) const {
    const Integer flag = hn::And(record_.whole(word + HELIOGRAPH_WORD(Slot, flags)),
                                 integer(static_cast<int>(slot_used)));
    return float_mask(hn::Ne(flag, integer(0)));
  }

  /// The slot that begins at `word` of the records; white where there is no texture, or where the
  /// slot has the flag `unless`.
  HWY_NOINLINE Float4 texel(int word, std::uint32_t unless = 0) {
    static_assert(offsetof(Slot, flags) == 32 && offsetof(Slot, wrap_s) == 48);
    const Float4 size = record_.four(word + HELIOGRAPH_WORD(Slot, flags));
    const TextureLanes flags{.flags = as_integer(size.x)};
    Mask used = flags.has(slot_used);
    if (unless) used = hn::AndNot(flags.has(unless), used);
    Float4 color{one(), one(), one(), one()};
    if (none(used)) return color;
    const Float4 wrap = record_.four(word + HELIOGRAPH_WORD(Slot, wrap_s));
    const TexturePlace& at = place(word, size, wrap, used);
    Float4 found;
    read_texture(scene_, at, as_integer(wrap.z), used, flags.has(shared::texture_srgb), found);
    return {select(used, found.x, color.x), select(used, found.y, color.y),
            select(used, found.z, color.z), select(used, found.w, color.w)};
  }

 private:
  HWY_INLINE const TexturePlace& place(int word, const Float4& size, const Float4& wrap,
                                       Mask used) {
    const Mask shares = TextureLanes{.flags = as_integer(size.x)}.has(slot_shares_place);
    if (placed_ && none(hn::AndNot(shares, used))) return shared_;
    static_assert(offsetof(Slot, row1) == 12 && offsetof(Slot, lod) == 24);
    const Float4 front = record_.four(word), back = record_.four(word + 4);
    const Mask first = float_mask(hn::Eq(as_integer(back.w), integer(0)));
    const Float x = select(first, lookup_.first.x, lookup_.second.x);
    const Float y = select(first, lookup_.first.y, lookup_.second.y);
    const Float2 uv{hn::MulAdd(front.x, x, hn::MulAdd(front.y, y, front.z)),
                    hn::MulAdd(front.w, x, hn::MulAdd(back.x, y, back.y))};
    const Float lod = hn::Add(back.z, select(first, lookup_.first_lod, lookup_.second_lod));
    const TextureLanes t{as_integer(size.y), as_integer(size.z), as_integer(wrap.x),
                         as_integer(wrap.y), as_integer(size.x), as_integer(size.w)};
    TexturePlace& to = word == first_slot<Record> ? shared_ : own_;
    place_texture<one_level>(t, uv, lod, to);
    placed_ |= word == first_slot<Record>;
    return to;
  }

  const SceneView& scene_;
  const Records& record_;
  const LookupLanes& lookup_;
  TexturePlace shared_;  // of the first slot
  TexturePlace own_;
  bool placed_ = false;
};

template <bool one_level>
using MaterialSlots = SlotReader<one_level, Material>;
template <bool one_level>
using LayerSlots = SlotReader<one_level, Layer>;

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
