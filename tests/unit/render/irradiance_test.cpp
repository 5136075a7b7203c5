#include "render/resources/environment/irradiance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace heliograph::render {
namespace {

/// A sky from a function of the direction.
template <typename Radiance>
scene::Environment make_sky(Radiance radiance) {
  scene::Environment sky{256, 128, {}};
  for (std::uint32_t y = 0; y < sky.height; ++y) {
    const double theta = (y + 0.5) / sky.height * std::numbers::pi;
    for (std::uint32_t x = 0; x < sky.width; ++x) {
      const double phi = ((x + 0.5) / sky.width - 0.5) * 2.0 * std::numbers::pi;
      sky.radiance.push_back(radiance(glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                 std::sin(theta) * std::sin(phi))));
    }
  }
  return sky;
}

const std::array<glm::vec3, 8> normals{{{1, 0, 0},
                                        {-1, 0, 0},
                                        {0, 1, 0},
                                        {0, -1, 0},
                                        {0, 0, 1},
                                        {0, 0, -1},
                                        {0.6f, 0.8f, 0},
                                        {0, -0.6f, 0.8f}}};

TEST(Irradiance, ConstantSkyGivesThatConstant) {
  const glm::vec3 radiance(1.0f, 0.5f, 3.0f);
  const auto coefficients = project_irradiance(scene::constant_environment(radiance));
  for (const glm::vec3& normal : normals) {
    EXPECT_LE(glm::distance(evaluate_irradiance(coefficients, normal), radiance), 1e-5f);
  }
}

// The cosine lobe's factor of band 1 is 2 pi / 3: a sky of radiance 1 + d.a gives 1 + 2/3 n.a.
TEST(Irradiance, LinearSkyIsAnalytic) {
  const glm::dvec3 axis(0.3, -0.5, 0.2);
  const auto coefficients = project_irradiance(
      make_sky([&](const glm::dvec3& d) { return glm::vec3(1.0 + glm::dot(d, axis)); }));
  for (const glm::vec3& normal : normals) {
    const double expected = 1.0 + 2.0 / 3.0 * glm::dot(glm::dvec3(normal), axis);
    EXPECT_NEAR(evaluate_irradiance(coefficients, normal).x, expected, 2e-4);
  }
}

// Band 2 carries a quarter: x y keeps its shape and a fourth of its size.
TEST(Irradiance, QuadraticSkyIsAnalytic) {
  const auto coefficients = project_irradiance(make_sky([](const glm::dvec3& d) {
    return glm::vec3(1.0 + d.x * d.y, 1.0 + d.y * d.z + d.x * d.z,
                     1.0 + 0.5 * (d.x * d.x - d.y * d.y));
  }));
  for (const glm::vec3& n : normals) {
    const glm::vec3 got = evaluate_irradiance(coefficients, n);
    EXPECT_NEAR(got.x, 1.0 + 0.25 * n.x * n.y, 3e-4);
    EXPECT_NEAR(got.y, 1.0 + 0.25 * (n.y * n.z + n.x * n.z), 3e-4);
    EXPECT_NEAR(got.z, 1.0 + 0.125 * (n.x * n.x - n.y * n.y), 3e-4);
  }
}

// Ramamoorthi and Hanrahan 2001: nine terms are within a few percent of any sky.
TEST(Irradiance, HalfSkyIsWithinFewPercent) {
  const auto coefficients = project_irradiance(
      make_sky([](const glm::dvec3& d) { return glm::vec3(d.y > 0.0 ? 1.0f : 0.0f); }));
  for (const glm::vec3& normal : normals) {
    const double expected = 0.5 * (1.0 + normal.y);
    EXPECT_NEAR(evaluate_irradiance(coefficients, normal).x, expected, 0.04);
  }
}

TEST(Irradiance, IsNeverNegative) {
  const auto coefficients = project_irradiance(
      make_sky([](const glm::dvec3& d) { return glm::vec3(d.y > 0.99 ? 1000.0f : 0.0f); }));
  for (const glm::vec3& normal : normals) {
    EXPECT_GE(evaluate_irradiance(coefficients, normal).x, 0.0f);
  }
}

}  // namespace
}  // namespace heliograph::render
