#include "render/irradiance.hpp"

#include <cmath>
#include <numbers>

namespace heliograph::render {
namespace {

/// The basis as polynomials: each term's function of the direction, without its constant.
std::array<double, 9> polynomials(const glm::dvec3& d) {
  return {1.0,
          d.y,
          d.z,
          d.x,
          d.x * d.y,
          d.y * d.z,
          3.0 * d.z * d.z - 1.0,
          d.x * d.z,
          d.x * d.x - d.y * d.y};
}

/// Normalisation of the basis squared (once to project, once to evaluate) times the cosine lobe's
/// factor over pi: 1, 2/3, 1/4 for the bands 0, 1, 2.
constexpr std::array<double, 9> factors() {
  constexpr double band0 = 0.282094791773878 * 0.282094791773878;
  constexpr double band1 = 0.488602511902920 * 0.488602511902920 * 2.0 / 3.0;
  constexpr double band2 = 1.092548430592079 * 1.092548430592079 / 4.0;
  constexpr double band2_z = 0.315391565252520 * 0.315391565252520 / 4.0;
  constexpr double band2_xy = 0.546274215296040 * 0.546274215296040 / 4.0;
  return {band0, band1, band1, band1, band2, band2, band2_z, band2, band2_xy};
}

}  // namespace

std::array<glm::vec4, 9> project_irradiance(const scene::Environment& environment) {
  constexpr double pi = std::numbers::pi;
  std::array<glm::dvec3, 9> sums{};
  const double step_phi = 2.0 * pi / environment.width;
  const double step_theta = pi / environment.height;
  for (std::uint32_t y = 0; y < environment.height; ++y) {
    const double theta = (y + 0.5) * step_theta;
    // The exact solid angle of a row's texel, so that a constant environment projects exactly.
    const double solid_angle =
        step_phi * (std::cos(y * step_theta) - std::cos((y + 1.0) * step_theta));
    for (std::uint32_t x = 0; x < environment.width; ++x) {
      const double phi = ((x + 0.5) / environment.width - 0.5) * 2.0 * pi;
      const glm::dvec3 direction{std::sin(theta) * std::cos(phi), std::cos(theta),
                                 std::sin(theta) * std::sin(phi)};
      const glm::dvec3 radiance = environment.radiance[std::size_t{y} * environment.width + x];
      const auto terms = polynomials(direction);
      for (std::size_t i = 0; i < 9; ++i) sums[i] += radiance * (terms[i] * solid_angle);
    }
  }
  std::array<glm::vec4, 9> coefficients{};
  for (std::size_t i = 0; i < 9; ++i) {
    coefficients[i] = glm::vec4(glm::vec3(sums[i] * factors()[i]), 0.0f);
  }
  return coefficients;
}

glm::vec3 evaluate_irradiance(const std::array<glm::vec4, 9>& coefficients,
                              const glm::vec3& normal) {
  const auto terms = polynomials(normal);
  glm::vec3 sum{0.0f};
  for (std::size_t i = 0; i < 9; ++i) {
    sum += glm::vec3(coefficients[i]) * static_cast<float>(terms[i]);
  }
  return glm::max(sum, glm::vec3(0.0f));
}

}  // namespace heliograph::render
