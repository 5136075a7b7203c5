#include "scene/environment_sun.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

namespace heliograph::scene::test {
namespace {

constexpr double pi = std::numbers::pi;

glm::dvec3 direction_of(std::uint32_t width, double x, double y) {
  const double theta = y / (width / 2) * pi, phi = (x / width - 0.5) * 2.0 * pi;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

/// Each texel is the mean of 8 x 8 directions.
Environment paint(std::uint32_t width,
                  const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
  Environment map{width, width / 2, {}};
  for (std::uint32_t y = 0; y < map.height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      glm::dvec3 sum(0.0);
      for (int i = 0; i < 64; ++i) {
        sum += radiance(direction_of(width, x + (i % 8 + 0.5) / 8, y + (i / 8 + 0.5) / 8)) / 64.0;
      }
      map.radiance.push_back(sum);
    }
  }
  return map;
}

/// A sky of radiance 1 with a disk of `degrees` diameter around `towards`.
Environment sky_with_disk(const glm::dvec3& towards, double degrees, const glm::dvec3& radiance,
                          std::uint32_t width = 512) {
  const double cosine = std::cos(0.5 * degrees * pi / 180.0);
  return paint(width, [&](const glm::dvec3& d) {
    return glm::dot(d, towards) > cosine ? radiance : glm::dvec3(1.0);
  });
}

glm::dvec3 flux(const Environment& map) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < map.radiance.size(); ++i) {
    const double top = static_cast<double>(i / map.width) / map.height * pi;
    const double bottom = top + pi / map.height;
    sum += glm::dvec3(map.radiance[i]) * (std::cos(top) - std::cos(bottom)) * 2.0 * pi /
           double(map.width);
  }
  return sum;
}

class SunSeparation : public testing::TestWithParam<glm::dvec3> {};

// One sun is on the seam of the map, one close to a pole.
TEST_P(SunSeparation, FindsDirectionDiameterAndIrradiance) {
  const glm::dvec3 towards = glm::normalize(GetParam());
  const glm::dvec3 radiance(8000.0, 6000.0, 3000.0);
  for (const double degrees : {1.5, 3.0, 5.0}) {
    const Environment whole = sky_with_disk(towards, degrees, radiance);
    const SeparatedEnvironment separated = separate_sun(whole);
    ASSERT_TRUE(separated.sun) << degrees;
    const double solid_angle = 2.0 * pi * (1.0 - std::cos(0.5 * degrees * pi / 180.0));
    EXPECT_GT(glm::dot(glm::dvec3(separated.sun->direction), towards), std::cos(0.1 * pi / 180.0));
    EXPECT_NEAR(separated.sun->angular_diameter, degrees, 0.1 * degrees + 0.2);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(separated.sun->irradiance[c] / (radiance[c] * solid_angle), 1.0, 0.05) << c;
    }
    for (const glm::vec3& texel : separated.sky.radiance) ASSERT_LT(texel.x, 200.0f);
    const glm::dvec3 before = flux(whole);
    const glm::dvec3 after = flux(separated.sky) + glm::dvec3(separated.sun->irradiance);
    EXPECT_LT(glm::length(after - before), 1e-4 * glm::length(before));
  }
}

INSTANTIATE_TEST_SUITE_P(Positions, SunSeparation,
                         testing::Values(glm::dvec3(0.3, 0.5, -0.6), glm::dvec3(-1.0, 0.4, 0.0),
                                         glm::dvec3(0.05, 1.0, 0.1)));

TEST(SunSeparation, SunOfOneTexelHasDiameterOfTexel) {
  Environment map = constant_environment(glm::vec3(1.0f));
  map = {256, 128, std::vector<glm::vec3>(256 * 128, glm::vec3(1.0f))};
  map.radiance[60 * 256 + 10] = glm::vec3(1e5f);
  const SeparatedEnvironment separated = separate_sun(map);
  ASSERT_TRUE(separated.sun);
  EXPECT_NEAR(separated.sun->angular_diameter, 360.0 / 256.0 * std::sqrt(4.0 / 3.0), 0.05);
  EXPECT_EQ(separated.sky.radiance[60 * 256 + 10], glm::vec3(1.0f));
}

TEST(SunSeparation, IgnoresLargeDimAndUniformLights) {
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 0.5, -0.6));
  EXPECT_FALSE(separate_sun(sky_with_disk(towards, 20.0, glm::dvec3(500.0))).sun) << "too large";
  EXPECT_FALSE(separate_sun(sky_with_disk(towards, 2.0, glm::dvec3(10.0))).sun) << "too dim";
  EXPECT_FALSE(separate_sun(constant_environment(glm::vec3(0.0f))).sun);
  const SeparatedEnvironment even = separate_sun(constant_environment(glm::vec3(3.0f)));
  EXPECT_FALSE(even.sun);
  EXPECT_EQ(even.sky.radiance[5], glm::vec3(3.0f));
}

TEST(SunSeparation, PreservesFluxOfPhotographs) {
  const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  for (const char* name : {"venice.hdr", "studio.hdr", "std_env.hdr"}) {
    const auto path = std::filesystem::path(assets) / "hdr" / name;
    if (!std::filesystem::exists(path)) continue;
    const Environment whole = load_environment(path);
    const SeparatedEnvironment separated = separate_sun(whole);
    glm::dvec3 after = flux(separated.sky);
    if (separated.sun) {
      std::printf("%s: sun of %.2f degrees, irradiance %.3f of %.3f\n", name,
                  separated.sun->angular_diameter, separated.sun->irradiance.y, after.y);
      EXPECT_NEAR(glm::length(separated.sun->direction), 1.0f, 1e-5f);
      after += glm::dvec3(separated.sun->irradiance);
    }
    EXPECT_LT(glm::length(after - flux(whole)), 1e-3 * glm::length(after)) << name;
  }
}

}  // namespace
}  // namespace heliograph::scene::test
