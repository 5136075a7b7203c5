#include "render/resources/environment/environment_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/resources/alias_table.hpp"

namespace heliograph::render {
namespace {

constexpr std::uint32_t widest_grid = 512;
constexpr double least_share = 0.01;  // of the mean

/// Luminance times solid angle of every cell.
std::vector<double> cell_weights(const scene::Environment& environment, std::uint32_t width) {
  const std::uint32_t height = width / 2;
  std::vector<double> sums(std::size_t{width} * height, 0.0), counts(sums.size(), 0.0);
  for (std::size_t y = 0; y < environment.height; ++y) {
    const std::size_t row = y * height / environment.height * width;
    for (std::size_t x = 0; x < environment.width; ++x) {
      const glm::dvec3 radiance = environment.radiance[y * environment.width + x];
      const std::size_t cell = row + x * width / environment.width;
      sums[cell] += glm::dot(radiance, glm::dvec3(0.2126, 0.7152, 0.0722));
      counts[cell] += 1.0;
    }
  }
  double mean = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) mean += sums[i] / counts[i] / sums.size();
  if (mean <= 0.0) mean = 1.0;
  const double step = std::numbers::pi / height;
  std::vector<double> weights(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double top = step * static_cast<double>(i / width);
    const double solid_angle = (std::cos(top) - std::cos(top + step)) * step;
    weights[i] = (sums[i] / counts[i] + least_share * mean) * solid_angle;
  }
  return weights;
}

}  // namespace

std::vector<EnvironmentCell> make_environment_table(const scene::Environment& environment) {
  const std::uint32_t narrow = std::min({environment.width, environment.height * 2, widest_grid});
  const std::uint32_t width = std::max(std::bit_floor(narrow), 2u);
  std::vector<double> weights = cell_weights(environment, width);
  double total = 0.0;
  for (const double weight : weights) total += weight;

  std::vector<EnvironmentCell> cells(weights.size());
  const double step = std::numbers::pi / (width / 2);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double top = step * static_cast<double>(i / width);
    const double solid_angle = (std::cos(top) - std::cos(top + step)) * step;
    cells[i] = {1.0f, static_cast<std::uint32_t>(i),
                static_cast<float>(weights[i] / total / solid_angle), 0.0f};
  }
  const std::vector<Alias> slots = make_alias_table(std::move(weights));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].threshold = slots[i].threshold;
    cells[i].alias = slots[i].item;
  }
  for (EnvironmentCell& cell : cells) cell.alias_density = cells[cell.alias].density;
  return cells;
}

}  // namespace heliograph::render
