// The lights of a grid's cells for host kernels: shaders/lib/lighting/light_grid.glsl in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_LIGHT_GRID_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_LIGHT_GRID_HPP
#undef HELIOGRAPH_KERNELS_LIGHT_GRID_HPP
#else
#define HELIOGRAPH_KERNELS_LIGHT_GRID_HPP
#endif

#include <array>
#include <cstring>

#include "render/kernels/simd/lights.hpp"
#include "render/resources/lights/light_grid.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What one entry of a cell sends, by the light that stands for it.
template <class V>
struct EntryLight {
  LightSample<V> way;
  Triple<V> sent;  // unshadowed, of all of the entry's lights; 0 where not lit
  V spread;        // tangent of the light's radius as seen from the surface
};

/// The lights of the cells in which positions lie. `picks`: uniform in [0, 1), says which light
/// stands for each entry.
template <class D, class Material>
class CellLights {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  HWY_INLINE CellLights(const SceneLights& lights, const Material& m, const Triple<V>& position,
                        V picks)
      : lights_(lights), m_(m), position_(position), picks_(picks) {}

  /// Calls `visit(lit, entry, numbers)` for the entries that send light to any lane: where they do,
  /// an EntryLight, and which lights stand for them.
  template <class Visit>
  HWY_INLINE void for_each(M requested, const Visit& visit) const {
    const VI first = first_entry();
    const auto lane = hn::FindKnownFirstTrue(d_, requested);
    const int shared = hn::ExtractLane(first, lane);
    const M same = hn::RebindMask(d_, hn::Eq(first, hn::Set(di_, shared)));
    if (hn::AllFalse(d_, hn::AndNot(same, requested))) {
      visit_shared(lights_.entries + shared, requested, visit);
    } else {
      visit_lanes(first, requested, visit);
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  /// Of the list of each position's cell.
  HWY_INLINE VI first_entry() const {
    const shared::LightGridHeader& grid = *lights_.grid;
    M inside = hn::Eq(hn::Zero(d_), hn::Zero(d_));
    const auto along = [&](V at, float origin, std::uint32_t cells) HWY_ATTR {
      const V cell = hn::Floor((at - set(origin)) * set(grid.inverse_size));
      inside = hn::And(inside, hn::Ge(cell, hn::Zero(d_)));
      inside = hn::And(inside, hn::Lt(cell, set(static_cast<float>(cells))));
      return cell;
    };
    const V x = along(position_.x, grid.origin.x, grid.cells.x);
    const V y = along(position_.y, grid.origin.y, grid.cells.y);
    const V z = along(position_.z, grid.origin.z, grid.cells.z);
    const auto size = [&](std::uint32_t n) HWY_ATTR { return set(static_cast<float>(n)); };
    // Whole numbers up to most_light_cells.
    const V cell = hn::MulAdd(hn::MulAdd(z, size(grid.cells.y), y), size(grid.cells.x), x);
    const V beyond = size(grid.cells.x * grid.cells.y * grid.cells.z);
    const VI list = hn::ConvertTo(di_, hn::IfThenElse(inside, cell, beyond));
    return hn::Mul(list, hn::Set(di_, static_cast<int>(shared::most_light_entries)));
  }

  HWY_INLINE V pick_of(std::uint32_t entry) const {
    const V pick = picks_ + set(static_cast<float>(entry) * shared::light_pick_step);
    return pick - hn::Floor(pick);
  }

  /// All lanes lie in the same cell.
  template <class Visit>
  HWY_INLINE void visit_shared(const shared::LightEntry* entries, M requested,
                               const Visit& visit) const {
    for (std::uint32_t i = 0; i < shared::most_light_entries && entries[i].slots != 0; ++i) {
      const shared::LightEntry& entry = entries[i];
      if (entry.single == shared::no_single_light) {
        visit_picked(i, hn::Set(di_, static_cast<int>(entry.first_slot)),
                     set(static_cast<float>(entry.slots)), requested, visit);
        continue;
      }
      const auto* const single = reinterpret_cast<const std::byte*>(&lights_.all[entry.single]);
      const auto four = [&](int word) HWY_ATTR {
        std::array<float, 4> words;
        std::memcpy(words.data(), single + 4 * word, sizeof words);
        return Quad<V>{set(words[0]), set(words[1]), set(words[2]), set(words[3])};
      };
      EntryLight<V> light;
      const M lit = contribution(four, set(1.0f), requested, light);
      if (hn::AllFalse(d_, lit)) continue;
      visit(lit, light, hn::Set(di_, static_cast<int>(entry.single)));
    }
  }

  /// Each lane reads the list of its own cell.
  template <class Visit>
  HWY_INLINE void visit_lanes(VI first, M requested, const Visit& visit) const {
    static_assert(sizeof(shared::LightEntry) == 16);
    const auto* const words = reinterpret_cast<const float*>(lights_.entries);
    const LaneIndices<D> lists(hn::ShiftLeft<2>(first));
    for (std::uint32_t i = 0; i < shared::most_light_entries; ++i) {
      const Quad<V> entry = four_words(d_, [&](std::size_t lane) HWY_ATTR {
        return words + lists.of[lane] + std::size_t{4} * i;
      });
      const VI slots = hn::BitCast(di_, entry.y);
      requested = hn::And(requested, hn::RebindMask(d_, hn::Gt(slots, hn::Zero(di_))));
      if (hn::AllFalse(d_, requested)) return;
      visit_picked(i, hn::BitCast(di_, entry.x), hn::ConvertTo(d_, slots), requested, visit);
    }
  }

  /// Of an entry with so many `slots` from `first` on.
  template <class Visit>
  HWY_INLINE void visit_picked(std::uint32_t entry, VI first, V slots, M requested,
                               const Visit& visit) const {
    static_assert(sizeof(shared::LightSlot) == 16 && sizeof(shared::Light) % 4 == 0);
    const V last = slots - set(1.0f);
    const VI step = hn::ConvertTo(di_, hn::Min(pick_of(entry) * slots, last));
    const VI slot = hn::IfThenElseZero(hn::RebindMask(di_, requested), hn::Add(first, step));
    const Quad<V> picked = records(lights_.slots, hn::ShiftLeft<2>(slot), 0);
    const VI numbers = hn::BitCast(di_, picked.x);
    const VI at = hn::Mul(numbers, hn::Set(di_, static_cast<int>(sizeof(shared::Light) / 4)));
    const auto four = [&](int word) HWY_ATTR { return records(lights_.all.data(), at, word); };
    EntryLight<V> light;
    const M lit = contribution(four, picked.y * slots, requested, light);
    if (!hn::AllFalse(d_, lit)) visit(lit, light, numbers);
  }

  /// Four words of a record for each lane, which begins at word `at` of a table.
  HWY_INLINE Quad<V> records(const void* table, VI at, int word) const {
    const auto* const words = static_cast<const float*>(table) + word;
    const LaneIndices<D> begin(at);
    return four_words(d_, [&](std::size_t lane) HWY_ATTR { return words + begin.of[lane]; });
  }

  /// light_contribution() of the punctual light whose words `four` gives, times `weight`.
  template <class Four>
  HWY_INLINE M contribution(const Four& four, V weight, M requested, EntryLight<V>& seen) const {
    using shared::Light;
    static_assert(HELIOGRAPH_WORD(Light, position) == 0 && HELIOGRAPH_WORD(Light, type) == 3);
    static_assert(HELIOGRAPH_WORD(Light, direction) == 4 && HELIOGRAPH_WORD(Light, range) == 7);
    static_assert(HELIOGRAPH_WORD(Light, color) == 8 && HELIOGRAPH_WORD(Light, radius) == 11);
    static_assert(HELIOGRAPH_WORD(Light, spot_scale) == 17);
    static_assert(HELIOGRAPH_WORD(Light, spot_offset) == 18);
    const V zero = hn::Zero(d_), one = set(1.0f);
    const Quad<V> place = four(0);
    const Triple<V> to_light = Triple<V>{place.x, place.y, place.z} - position_;
    const V squared = hn::Max(dot(to_light, to_light), set(1e-8f));
    M lit = hn::And(requested, is_lit_from(m_, to_light));
    if (hn::AllFalse(d_, lit)) return lit;
    const Quad<V> facing = four(4);
    const V range = facing.w;
    const M ends = hn::Gt(range, zero);
    lit = hn::And(lit, hn::Or(hn::Not(ends), hn::Lt(squared, range * range)));
    if (hn::AllFalse(d_, lit)) return lit;
    const V inverse = reciprocal_sqrt(squared);
    seen.way.distance = squared * inverse;
    seen.way.direction = to_light * inverse;
    seen.way.attenuation = weight * inverse * inverse;
    if (!hn::AllFalse(d_, ends)) {
      const V q = hn::IfThenElseZero(ends, squared / hn::IfThenElse(ends, range * range, one));
      const V falls = hn::Max(hn::NegMulAdd(q, q, one), zero);
      seen.way.attenuation = seen.way.attenuation * falls;
    }
    if (lights_.grid->has_spots != 0) {
      const Triple<V> axis{facing.x, facing.y, facing.z};
      const VI type = hn::BitCast(di_, place.w);
      const V inside = cone(four(16), hn::Neg(dot(axis, seen.way.direction)));
      const VI spot = hn::Set(di_, static_cast<int>(shared::light_spot));
      const M is_spot = hn::RebindMask(d_, hn::Eq(type, spot));
      seen.way.attenuation = seen.way.attenuation * hn::IfThenElse(is_spot, inside, one);
    }
    const Quad<V> color = four(8);
    seen.spread = color.w * inverse;
    const Triple<V> sent = Triple<V>{color.x, color.y, color.z} * seen.way.attenuation *
                           shade_light_of_side(d_, m_, seen.way.direction);
    seen.sent = {hn::IfThenElseZero(lit, sent.x), hn::IfThenElseZero(lit, sent.y),
                 hn::IfThenElseZero(lit, sent.z)};
    return lit;
  }

  /// Of a spot's light, along a direction with this `cosine` to its axis. `words`: from
  /// half_height on.
  HWY_INLINE V cone(const Quad<V>& words, V cosine) const {
    const V linear = clamped(hn::MulAdd(cosine, words.y, words.z), 0.0f, 1.0f);
    return linear * linear;
  }

  const D d_{};
  const DI di_{};
  const SceneLights& lights_;
  const Material& m_;
  const Triple<V>& position_;
  V picks_;
};

/// Light of all lights of the cells, unshadowed.
template <class D, class Material, class V = hn::Vec<D>>
HWY_INLINE Triple<V> cell_light(D d, const SceneLights& lights, const Material& m,
                                const Triple<V>& position, hn::Mask<D> requested, V picks) {
  Triple<V> sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  if (hn::AllFalse(d, requested)) return sum;
  CellLights<D, Material>(lights, m, position, picks)
      .for_each(requested, [&](hn::Mask<D>, const EntryLight<V>& light, const auto&)
                               HWY_ATTR { sum = sum + light.sent; });
  return sum;
}

/// choose_light() among all lights that count where the surfaces are. `picks`: as above.
template <class Material>
HWY_INLINE LightChoice choose_light(const SceneLights& lights, const SquareTexels& ltc,
                                    const Material& m, const Float3& position, Mask requested,
                                    Float picks, Float& pick) {
  LightChoice choice = no_choice();
  for (const std::uint32_t i : lights.outside) {
    offer_light(choice, lights.all[i], static_cast<int>(i), ltc, m, position, requested, pick);
  }
  if (!lights.grid || none(requested)) return choice;
  CellLights<Tag, Material>(lights, m, position, picks)
      .for_each(requested, [&](Mask, const EntryLight<Float>& light, Integer numbers) HWY_ATTR {
        const Mask chosen = offer(choice, light.sent, pick);
        choice.number = select(chosen, numbers, choice.number);
        keep_way(choice, chosen, light.way, light.spread);
      });
  return choice;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
