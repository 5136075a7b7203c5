#pragma once

#include <glm/glm.hpp>
#include <vector>

/// Measures of the atrium: a courtyard open to the sky, with an arcade of two storeys on all four
/// sides. The nave runs along X; the origin is the middle of its floor. Metres.
namespace heliograph::scenes::plan {

inline constexpr float bay = 4.0f;
inline constexpr int long_bays = 8;
inline constexpr int short_bays = 3;
inline constexpr glm::vec2 arcade{16.0f, 5.0f};  // half extents of the column axes, x and z
inline constexpr glm::vec2 walls{20.0f, 10.0f};  // half extents inside the outer walls
inline constexpr float short_bay = 2.0f * arcade.y / float(short_bays);
inline constexpr float wall_thickness = 0.7f;
inline constexpr float half_wall = 0.5f * wall_thickness;

struct Storey {
  float floor;
  float springing;    // of the arches, top of the capitals
  float arch_radius;  // of the long bays; narrower bays keep the same distance to the axis
  float wall_top;     // underside of the cornice
  float top;
};
inline constexpr Storey lower{0.0f, 4.2f, 1.5f, 6.1f, 6.6f};
inline constexpr Storey upper{6.6f, 10.0f, 1.68f, 12.35f, 12.9f};

inline constexpr float vault_springing = 4.2f;  // of the aisles

// The roof rises outwards from the eaves to its ridge, this far behind the column axes.
inline constexpr float roof_depth = 5.4f;
inline constexpr float ridge_height = 14.9f;

inline float arch_radius(const Storey& storey, float bay_width) {
  return storey.arch_radius - 0.5f * (bay - bay_width);
}

/// A place on the plan and the turn about Y that makes local +Z face the courtyard.
struct Spot {
  glm::vec2 position{0.0f};  // x and z
  float turn = 0.0f;         // degrees
  bool on_long_side = true;

  glm::vec3 at(float height) const { return {position.x, height, position.y}; }
};

/// Middles of the arcade bays, the 16 long ones first.
std::vector<Spot> bays();

/// Column axes, the 18 of the long sides first; the corners are theirs.
std::vector<Spot> columns();

/// The four sides, at the given distance outwards from the column axes (negative: inwards).
std::vector<Spot> sides(float outwards);

}  // namespace heliograph::scenes::plan
