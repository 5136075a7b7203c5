#include "render/resources/environment/upper_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render/resources/r2_sequence.hpp"

namespace heliograph::render {
namespace {

/// The squares of the sines of the polar angles at the upper and the lower edge of a row, of which
/// what is below the horizon is cut off: cos x sin is even over them.
std::array<double, 2> row_edges(std::uint32_t row, const scene::Environment& map) {
  const auto edge = [&map](std::uint32_t at) {
    const double sine = std::sin(std::numbers::pi * std::min(1.0 * at / map.height, 0.5));
    return sine * sine;
  };
  return {edge(row), edge(row + 1)};
}

/// Light of the texels of a row on a surface that faces up, over their luminance.
double row_weight(std::uint32_t row, const scene::Environment& map) {
  const auto [upper, lower] = row_edges(row, map);
  return (lower - upper) * std::numbers::pi / map.width;
}

/// The direction at column `u` of the map, from 0 to 1, and this square of the polar angle's sine.
glm::vec3 direction_at(double u, double squared_sine) {
  const double azimuth = (u - 0.5) * 2.0 * std::numbers::pi, sine = std::sqrt(squared_sine);
  return {sine * std::cos(azimuth), std::sqrt(1.0 - squared_sine), sine * std::sin(azimuth)};
}

}  // namespace

UpperLight upper_light(const scene::Environment& map, std::size_t count) {
  const std::uint32_t rows = (map.height + 1) / 2;
  const auto brightness = [&map](std::uint32_t row, std::uint32_t column) {
    return brightness_of(map.radiance[std::size_t{row} * map.width + column]);
  };
  double total = 0.0;
  for (std::uint32_t y = 0; y < rows; ++y) {
    double sum = 0.0;
    for (std::uint32_t x = 0; x < map.width; ++x) sum += brightness(y, x);
    total += row_weight(y, map) * sum;
  }
  UpperLight light;
  light.irradiance = static_cast<float>(total);
  if (!(total > 0.0)) return light;
  double passed = 0.0;
  for (std::uint32_t y = 0; y < rows; ++y) {
    const auto [upper, lower] = row_edges(y, map);
    const double weight = row_weight(y, map);
    for (std::uint32_t x = 0; x < map.width; ++x) {
      passed += weight * brightness(y, x);
      // The middle of each of `count` equal parts of the light.
      const double due = passed / total * static_cast<double>(count) - 0.5;
      while (static_cast<double>(light.directions.size()) <= due) {
        const std::size_t drawn = light.directions.size();
        if (drawn == count) break;
        const glm::dvec2 within = r2_point(drawn);
        light.directions.push_back(
            direction_at((x + within.x) / map.width, std::lerp(upper, lower, within.y)));
      }
    }
  }
  // Rounding may leave out the last.
  while (light.directions.size() < count) light.directions.push_back(light.directions.back());
  return light;
}

}  // namespace heliograph::render
