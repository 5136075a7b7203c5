#include "scenes/generator/textures/noise.hpp"

#include <array>
#include <cmath>

namespace heliograph::scenes {
namespace {

int wrap(int value, int period) {
  const int rest = value % period;
  return rest < 0 ? rest + period : rest;
}

glm::vec2 lattice_gradient(int x, int y, std::uint32_t seed) {
  constexpr std::size_t count = 64;
  static const auto directions = [] {
    std::array<glm::vec2, count> table;
    for (std::size_t i = 0; i < count; ++i) {
      const float angle = 6.2831853f * (float(i) + 0.5f) / float(count);
      table[i] = {std::cos(angle), std::sin(angle)};
    }
    return table;
  }();
  return directions[hash(x, y, seed) % count];
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

/// Gradient noise (Perlin 2002) with `cells` lattice cells per period, about [-1, 1].
float gradient_noise(glm::vec2 p, glm::ivec2 cells, std::uint32_t seed) {
  const glm::vec2 scaled = p * glm::vec2(cells);
  const glm::vec2 corner = glm::floor(scaled);
  const glm::vec2 f = scaled - corner;
  const glm::ivec2 c(corner);
  const auto contribution = [&](int dx, int dy) {
    const glm::vec2 gradient =
        lattice_gradient(wrap(c.x + dx, cells.x), wrap(c.y + dy, cells.y), seed);
    return glm::dot(gradient, f - glm::vec2(dx, dy));
  };
  const float bottom = glm::mix(contribution(0, 0), contribution(1, 0), fade(f.x));
  const float top = glm::mix(contribution(0, 1), contribution(1, 1), fade(f.x));
  return 1.4f * glm::mix(bottom, top, fade(f.y));
}

}  // namespace

std::uint32_t hash(int x, int y, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9E3779B9u ^ std::uint32_t(x) * 0x85EBCA6Bu;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du + std::uint32_t(y) * 0xC2B2AE35u;
  h = (h ^ (h >> 13)) * 0x297A2D39u;
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  return h ^ (h >> 15);
}

float hash_unit(int x, int y, std::uint32_t seed) {
  return float(hash(x, y, seed) >> 8) * (1.0f / 16777216.0f);
}

float fractal_noise(glm::vec2 p, glm::ivec2 cells, int octaves, std::uint32_t seed, float gain) {
  float sum = 0.0f;
  float height = 1.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += height * gradient_noise(p, cells, seed + std::uint32_t(octave) * 101u);
    height *= gain;
    cells *= 2;
  }
  return sum;
}

float ridge_noise(glm::vec2 p, glm::ivec2 cells, int octaves, std::uint32_t seed) {
  return 1.0f - std::fmin(1.0f, std::abs(fractal_noise(p, cells, octaves, seed)));
}

Cell cellular_noise(glm::vec2 p, glm::ivec2 cells, std::uint32_t seed, float jitter) {
  const glm::vec2 scaled = p * glm::vec2(cells);
  const glm::ivec2 home(glm::floor(scaled));
  float first = 1e9f;
  float second = 1e9f;
  float identity = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const glm::ivec2 cell = home + glm::ivec2(dx, dy);
      const int x = wrap(cell.x, cells.x);
      const int y = wrap(cell.y, cells.y);
      const glm::vec2 offset(hash_unit(x, y, seed), hash_unit(x, y, seed + 1u));
      const glm::vec2 feature = glm::vec2(cell) + glm::mix(glm::vec2(0.5f), offset, jitter);
      const float distance = glm::distance(scaled, feature);
      if (distance < first) {
        second = first;
        first = distance;
        identity = hash_unit(x, y, seed + 2u);
      } else if (distance < second) {
        second = distance;
      }
    }
  }
  return {first, second - first, identity};
}

}  // namespace heliograph::scenes
