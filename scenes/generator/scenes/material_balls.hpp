#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/environment.hpp"

namespace heliograph::scenes {

inline constexpr std::size_t balls_per_row = 5;

/// A row of the chart: one property of glTF's materials at `balls_per_row` values, from left to
/// right. A material's name is the row's and the value: `sheen_roughness=0.25`.
struct BallRow {
  std::string name;
  std::vector<Material> materials;
};

/// In reading order: down the first block of eight rows, then the second and the third.
std::vector<BallRow> ball_rows();

/// Balls of one metre on a checkered ground, a node of its material's name each. The camera `main`
/// sees all of them; one named as each row sees that row in an image of 5 to 1, a ball in the
/// middle of each of its five squares.
Document make_material_balls();

/// The studio around them.
Environment make_material_balls_environment();

}  // namespace heliograph::scenes
