#pragma once

#include <cstdint>
#include <vector>

#include "scene/environment.hpp"

namespace heliograph::render {

/// One cell of a grid over all directions, as shaders/lib/lighting/environment_sampling.glsl reads
/// it.
struct EnvironmentCell {
  float threshold;      // below it a number in [0, 1) stays with this cell, else it takes
  std::uint32_t alias;  // this one
  float density;        // of this cell, per steradian
  float alias_density;  // of the other
};

/// Draws directions in proportion to their luminance, all cells in one look-up (the alias method;
/// Walker 1977, Vose 1991). Cells are as high as wide in angle, twice as many around as from pole
/// to pole, row 0 up; never more of them than the map has texels, at most 512 x 256. Dark cells
/// keep a small probability, because texels are interpolated across cells.
std::vector<EnvironmentCell> make_environment_table(const scene::Environment& environment);

}  // namespace heliograph::render
