#include "render/resources/environment/background.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace heliograph::render {
namespace {

using protocol::BackgroundKind;

protocol::Settings::Background chosen(BackgroundKind show, float blur = 0.0f) {
  protocol::Settings::Background settings;
  settings.show = show;
  settings.blur = blur;
  return settings;
}

/// Radiance 1 but for a bright half toward +x.
scene::Environment two_halves() {
  scene::Environment map{256, 128, {}};
  for (std::uint32_t y = 0; y < map.height; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      map.radiance.emplace_back(x >= 64 && x < 192 ? 3.0f : 1.0f);
    }
  }
  return map;
}

glm::vec3 mean(const scene::Environment& map) {
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (std::uint32_t y = 0; y < map.height; ++y) {
    const double weight = std::sin((y + 0.5) / map.height * std::numbers::pi);
    for (std::uint32_t x = 0; x < map.width; ++x) {
      sum += weight * glm::dvec3(map.radiance[y * map.width + x]);
      weights += weight;
    }
  }
  return sum / weights;
}

/// Of the texel at these fractions of width and height.
float texel(const scene::Environment& map, double x, double y) {
  const auto column = static_cast<std::uint32_t>(x * map.width);
  const auto row = static_cast<std::uint32_t>(y * map.height);
  return map.radiance[row * map.width + column].x;
}

TEST(Background, BlurKeepsTheMeanAndFlattensWithItsWidth) {
  const scene::Environment map = two_halves();
  const auto slight = background_map(map, chosen(BackgroundKind::blurred, 0.0f));
  const auto strong = background_map(map, chosen(BackgroundKind::blurred, 1.0f));
  EXPECT_NEAR(mean(slight).x, 2.0f, 0.01f);
  EXPECT_NEAR(mean(strong).x, 2.0f, 0.02f);
  EXPECT_NEAR(texel(slight, 0.5, 0.5), 3.0f, 0.01f);
  EXPECT_NEAR(texel(slight, 0.01, 0.5), 1.0f, 0.01f);
  EXPECT_LT(texel(strong, 0.5, 0.5), 2.95f);
  EXPECT_GT(texel(strong, 0.5, 0.5), texel(strong, 0.3, 0.5));
  // The poles see both halves alike.
  EXPECT_NEAR(texel(strong, 0.5, 0.0), 2.0f, 0.1f);
}

TEST(Background, BlurOfAConstantEnvironmentIsThatConstant) {
  const auto map = background_map(scene::constant_environment(glm::vec3(0.25f, 0.5f, 2.0f)),
                                  chosen(BackgroundKind::blurred, 0.5f));
  for (const glm::vec3& radiance : map.radiance) {
    EXPECT_LE(glm::distance(radiance, glm::vec3(0.25f, 0.5f, 2.0f)), 1e-4f);
  }
}

TEST(Background, BlurLeavesTheSunOut) {
  scene::Environment map{512, 256, std::vector<glm::vec3>(512 * 256, glm::vec3(1.0f))};
  map.radiance[100 * 512 + 100] = glm::vec3(50'000.0f);
  for (const glm::vec3& radiance :
       background_map(map, chosen(BackgroundKind::blurred, 0.0f)).radiance) {
    EXPECT_NEAR(radiance.x, 1.0f, 0.01f);
  }
}

TEST(Background, GradientHasTheColorsAtItsEnds) {
  auto settings = chosen(BackgroundKind::gradient);
  settings.color = {0xffffff};
  settings.upper_color = {0x000000};
  const auto map = background_map(two_halves(), settings);
  EXPECT_FLOAT_EQ(texel(map, 0.5, 0.99), 1.0f);
  EXPECT_FLOAT_EQ(texel(map, 0.5, 0.0), 0.0f);
  for (std::size_t row = 1; row < map.radiance.size(); ++row) {
    EXPECT_GE(map.radiance[row].x, map.radiance[row - 1].x);
  }
}

TEST(Background, ColorIsLinearRadiance) {
  auto settings = chosen(BackgroundKind::color);
  settings.color = {0xff8000};
  const auto map = background_map(two_halves(), settings);
  ASSERT_EQ(map.radiance.size(), 1u);
  EXPECT_FLOAT_EQ(map.radiance[0].x, 1.0f);
  EXPECT_NEAR(map.radiance[0].y, 0.2159f, 1e-4f);  // of 128 / 255
  EXPECT_FLOAT_EQ(map.radiance[0].z, 0.0f);
}

}  // namespace
}  // namespace heliograph::render
