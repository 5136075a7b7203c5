#include "render/resources/environment/upper_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace heliograph::render {
namespace {

/// Light of the texels of a row on a surface that faces up, over their luminance.
double row_weight(std::uint32_t row, const scene::Environment& map) {
  constexpr double pi = std::numbers::pi;
  const double from = pi * row / map.height, to = pi * (row + 1.0) / map.height;
  if (from >= 0.5 * pi) return 0.0;
  // The integral of cos x sin over the polar angles above the horizon.
  const double low = std::sin(from), high = std::sin(std::min(to, 0.5 * pi));
  return 0.5 * (high * high - low * low) * 2.0 * pi / map.width;
}

/// A number in [0, 1) for the `i`th of a sequence that fills the interval evenly.
double even(std::size_t i, double step) {
  const double at = 0.5 + static_cast<double>(i) * step;
  return at - std::floor(at);
}

/// The direction of a place in the map, both from 0 to 1.
glm::vec3 direction_at(double u, double v) {
  const double azimuth = (u - 0.5) * 2.0 * std::numbers::pi, polar = v * std::numbers::pi;
  return {std::sin(polar) * std::cos(azimuth), std::cos(polar),
          std::sin(polar) * std::sin(azimuth)};
}

}  // namespace

UpperLight upper_light(const scene::Environment& map, std::size_t count) {
  double total = 0.0;
  const auto weight = [&map](std::uint32_t row, std::uint32_t column) {
    const std::size_t texel = std::size_t{row} * map.width + column;
    return row_weight(row, map) * brightness_of(map.radiance[texel]);
  };
  const std::uint32_t rows = (map.height + 1) / 2;
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) total += weight(y, x);
  }
  UpperLight light;
  light.irradiance = static_cast<float>(total);
  if (!(total > 0.0)) return light;
  double passed = 0.0;
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      passed += weight(y, x);
      for (std::size_t i = light.directions.size();
           i < count &&
           passed * static_cast<double>(count) >= (static_cast<double>(i) + 0.5) * total;
           i = light.directions.size()) {
        const double u = (x + even(i, 0.7548776662466927)) / map.width;
        const double v = (y + even(i, 0.5698402909980532)) / map.height;
        light.directions.push_back(direction_at(u, std::min(v, 0.4999)));
      }
    }
  }
  // Rounding may leave out the last.
  while (light.directions.size() < count) light.directions.push_back(light.directions.back());
  return light;
}

}  // namespace heliograph::render
