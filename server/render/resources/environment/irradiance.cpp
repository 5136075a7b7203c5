#include "render/resources/environment/irradiance.hpp"

#include <cmath>
#include <numbers>
#include <vector>

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

/// Integrals over a row's polar angles, from the zenith down: of sin t times each factor that the
/// polynomials have there.
struct RowIntegrals {
  RowIntegrals(double t0, double t1) {
    const double c0 = std::cos(t0), c1 = std::cos(t1);
    const double s0 = std::sin(t0), s1 = std::sin(t1);
    one = c0 - c1;
    cosine = 0.5 * (c0 * c0 - c1 * c1);
    cosine_squared = (c0 * c0 * c0 - c1 * c1 * c1) / 3.0;
    sine = 0.5 * (t1 - t0 - (s1 * c1 - s0 * c0));
    sine_cosine = (s1 * s1 * s1 - s0 * s0 * s0) / 3.0;
    sine_squared = one - cosine_squared;
  }
  double one, cosine, cosine_squared, sine, sine_cosine, sine_squared;
};

/// Integrals over a column's azimuths.
struct ColumnIntegrals {
  ColumnIntegrals(double p0, double p1) {
    const double c0 = std::cos(p0), c1 = std::cos(p1);
    const double s0 = std::sin(p0), s1 = std::sin(p1);
    one = p1 - p0;
    cosine = s1 - s0;
    sine = c0 - c1;
    cosine_squared = 0.5 * (one + s1 * c1 - s0 * c0);
    sine_squared = one - cosine_squared;
    sine_cosine = 0.5 * (s1 * s1 - s0 * s0);
  }
  double one, cosine, sine, cosine_squared, sine_squared, sine_cosine;
};

/// Each polynomial integrated over one texel, exactly: a small constant environment projects as
/// well as a large one.
std::array<double, 9> texel_integrals(const RowIntegrals& row, const ColumnIntegrals& column) {
  return {row.one * column.one,
          row.cosine * column.one,
          row.sine * column.sine,
          row.sine * column.cosine,
          row.sine_cosine * column.cosine,
          row.sine_cosine * column.sine,
          3.0 * row.sine_squared * column.sine_squared - row.one * column.one,
          row.sine_squared * column.sine_cosine,
          row.sine_squared * column.cosine_squared - row.cosine_squared * column.one};
}

}  // namespace

std::array<glm::vec4, 9> project_irradiance(const scene::Environment& environment) {
  constexpr double pi = std::numbers::pi;
  const double step_theta = pi / environment.height;
  const double step_phi = 2.0 * pi / environment.width;
  std::vector<ColumnIntegrals> columns;
  for (std::uint32_t x = 0; x < environment.width; ++x) {
    columns.emplace_back(x * step_phi - pi, (x + 1.0) * step_phi - pi);
  }
  std::array<glm::dvec3, 9> sums{};
  for (std::uint32_t y = 0; y < environment.height; ++y) {
    const RowIntegrals row(y * step_theta, (y + 1.0) * step_theta);
    for (std::uint32_t x = 0; x < environment.width; ++x) {
      const glm::dvec3 radiance = environment.radiance[std::size_t{y} * environment.width + x];
      const auto terms = texel_integrals(row, columns[x]);
      for (std::size_t i = 0; i < 9; ++i) sums[i] += radiance * terms[i];
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
