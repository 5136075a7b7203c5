#pragma once

#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/scenes/clips.hpp"

namespace heliograph::scenes {

/// Indices into Document::materials.
struct BreakfastMaterials {
  int floor, plaster, accent, ceiling, frame, slat;
  int table, chair, cushion, rug, runner;
  int china, cup, bowl, lemon, steel, brass;
  int shade, bulb_cord, painting_frame, toy;
  int paintings[3];
};

namespace breakfast {

inline constexpr float half_room = 4.0f;
inline constexpr float room_height = 3.2f;
inline constexpr float table_height = 0.78f;
inline constexpr float table_radius = 1.12f;
inline constexpr int seats = 5;
/// Where the table stands: in the sun that the windows let in.
inline constexpr glm::vec3 table_foot(1.2f, 0.0f, -0.2f);

/// Degrees from +X towards +Z at which a seat's middle lies, seen from the table.
constexpr float seat_angle(int seat) {
  return 17.0f + 72.0f * float(seat);
}

}  // namespace breakfast

void add_shell(Document& document, const BreakfastMaterials& materials);
void add_windows(Document& document, const BreakfastMaterials& materials);
void add_table_and_chairs(Document& document, const BreakfastMaterials& materials);
void add_paintings(Document& document, const BreakfastMaterials& materials);
/// The hanging light moves up and down over the table.
void add_hanging_light(Document& document, const BreakfastMaterials& materials, Animation& objects);
void add_tableware(Document& document, const BreakfastMaterials& materials);

}  // namespace heliograph::scenes
