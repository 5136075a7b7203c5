#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace heliograph::scenes {

/// Every function here repeats with period 1 in both coordinates, so that textures tile.

/// Well mixed 32 bits from lattice coordinates and a seed.
std::uint32_t hash(int x, int y, std::uint32_t seed);

/// The same as a number in [0, 1).
float hash_unit(int x, int y, std::uint32_t seed);

/// Sum of octaves of gradient noise, each of twice the frequency and `gain` times the height.
float fractal_noise(glm::vec2 p, glm::ivec2 cells, int octaves, std::uint32_t seed,
                    float gain = 0.5f);

/// 1 on the zero lines of fractal noise, falling to 0 away from them: veins and cracks.
float ridge_noise(glm::vec2 p, glm::ivec2 cells, int octaves, std::uint32_t seed);

/// Cellular noise (Worley 1996): the nearest feature point.
struct Cell {
  float nearest = 0.0f;   // distance to the nearest feature point, in cells
  float border = 0.0f;    // second nearest minus nearest: 0 on the border between two cells
  float identity = 0.0f;  // a random number in [0, 1) that belongs to the cell
};
Cell cellular_noise(glm::vec2 p, glm::ivec2 cells, std::uint32_t seed, float jitter = 1.0f);

}  // namespace heliograph::scenes
