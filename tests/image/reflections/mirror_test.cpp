#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/generator/scenes/test_scenes.hpp"
#include "scenes/generator/sky/sky.hpp"
#include "tests/image/support/scene_renderer.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 240, height = 180;
constexpr glm::dvec3 center(0.0, 0.45, 0.0);
constexpr double radius = 0.45;

/// Bilinear, with the equator joined and the poles clamped.
glm::dvec3 look_up(const scene::Environment& sky, const glm::dvec3& d) {
  const double u = (0.5 + std::atan2(d.z, d.x) / (2.0 * std::numbers::pi)) * sky.width - 0.5;
  const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi * sky.height - 0.5;
  const auto texel = [&](int x, int y) {
    const int w = static_cast<int>(sky.width), h = static_cast<int>(sky.height);
    return glm::dvec3(sky.radiance[std::clamp(y, 0, h - 1) * w + (x % w + w) % w]);
  };
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), u - x),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), u - x), v - y);
}

/// World direction through a pixel's middle.
glm::dvec3 view_ray(const scene::Camera& camera, std::uint32_t x, std::uint32_t y) {
  const double slope = std::tan(glm::radians(0.5 * camera.vertical_fov));
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target - camera.eye));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right, forward);
  return glm::normalize(forward +
                        right * (slope * width / height * ((x + 0.5) / width * 2.0 - 1.0)) -
                        up * (slope * ((y + 0.5) / height * 2.0 - 1.0)));
}

struct Errors {
  double median = 0.0, worst = 0.0;  // relative to what the sphere should show
  int pixels = 0;
};

/// Holds every pixel of the mirror sphere against the environment in the direction it reflects.
Errors reflection_errors(const scene::Environment& sky, float rotation, bool traced,
                         const std::string& name) {
  const auto scene = import_document(scenes::make_mirror(), 16);
  const scene::Camera camera = scene->cameras.at(0);
  Still still(scene, sky, camera, width, height);
  protocol::Settings settings;
  settings.ambient.occlusion = false;
  settings.antialiasing.jitter = settings.antialiasing.temporal = false;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.specular.enabled = traced;
  settings.environment.rotation = rotation;
  still.apply(settings);
  save_picture(name + (traced ? "_traced" : "_prefiltered"), still.accumulate(1));
  const render::FloatImage hdr = still.capture("hdr");
  const double angle = glm::radians(-static_cast<double>(rotation));
  std::vector<double> errors;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const glm::dvec3 ray = view_ray(camera, x, y);
      const glm::dvec3 to_eye = glm::dvec3(camera.eye) - center;
      const double b = glm::dot(to_eye, ray), c = glm::dot(to_eye, to_eye) - radius * radius;
      if (b * b <= c) continue;
      const glm::dvec3 normal = (to_eye + ray * (-b - std::sqrt(b * b - c))) / radius;
      if (-glm::dot(normal, ray) < 0.25) continue;  // flat triangles show at the rim
      const glm::dvec3 r = glm::reflect(ray, normal);
      if (traced && r.y < 0.05) continue;  // the ground is in the way
      const glm::dvec3 turned(std::cos(angle) * r.x + std::sin(angle) * r.z, r.y,
                              std::cos(angle) * r.z - std::sin(angle) * r.x);
      const glm::dvec3 expected = look_up(sky, turned);
      errors.push_back(glm::distance(glm::dvec3(rgb(hdr, x, y)), expected) / glm::length(expected));
    }
  }
  std::sort(errors.begin(), errors.end());
  return {errors.at(errors.size() / 2), errors.back(), static_cast<int>(errors.size())};
}

// What the environment's prefiltered cube shows, and what rays do.
class Mirror : public testing::TestWithParam<bool> {};

TEST_P(Mirror, ReflectsGeneratedSky) {
  const auto sky = scenes::make_clear_sky(scenes::direction_to_sun(50.0f, 30.0f), 512, 256);
  const Errors errors = reflection_errors(convert(sky.environment), 0.0f, GetParam(), "mirror_sky");
  EXPECT_GT(errors.pixels, GetParam() ? 1500 : 2000);
  EXPECT_LT(errors.median, GetParam() ? 0.002 : 0.01);
  EXPECT_LT(errors.worst, GetParam() ? 0.05 : 0.15);  // at the horizon, sharper than the cube
}

/// Every axis another colour, and a red glow in one direction: a flip or a turn moves it.
glm::vec3 coloured_sky(const glm::vec3& d) {
  const glm::vec3 glow = glm::normalize(glm::vec3(0.8f, 0.5f, 0.6f));
  return glm::vec3(1.0f) + 0.6f * d +
         glm::vec3(8, 0, 0) * std::pow(std::max(glm::dot(d, glow), 0.0f), 40.0f);
}

TEST_P(Mirror, ReflectsColoredSkyInCorrectOrientation) {
  const Errors errors =
      reflection_errors(make_environment(512, coloured_sky), 0.0f, GetParam(), "mirror_coloured");
  EXPECT_LT(errors.median, GetParam() ? 0.001 : 0.005);
  EXPECT_LT(errors.worst, GetParam() ? 0.02 : 0.05);
}

TEST_P(Mirror, RotatesWithEnvironment) {
  const Errors errors =
      reflection_errors(make_environment(512, coloured_sky), 70.0f, GetParam(), "mirror_turned");
  EXPECT_LT(errors.median, GetParam() ? 0.001 : 0.005);
  EXPECT_LT(errors.worst, GetParam() ? 0.02 : 0.05);
}

std::string way_name(const testing::TestParamInfo<bool>& way) {
  return way.param ? "traced" : "prefiltered";
}

INSTANTIATE_TEST_SUITE_P(Ways, Mirror, testing::Bool(), way_name);

TEST(Background, ShowsEnvironmentBehindEveryPixel) {
  const scene::Environment sky = make_environment(512, coloured_sky);
  const scene::Camera camera = look({0, 0, 0}, {1, 0.3f, 0.8f}, 60.0f);
  Still still(SceneBuilder().build(), sky, camera, width, height);
  protocol::Settings settings;
  settings.antialiasing.jitter = false;
  still.apply(settings);
  save_picture("background", still.accumulate(1));
  const render::FloatImage hdr = still.capture("hdr");
  for (std::uint32_t y = 0; y < height; y += 3) {
    for (std::uint32_t x = 0; x < width; x += 3) {
      const glm::dvec3 expected = look_up(sky, view_ray(camera, x, y));
      ASSERT_LE(glm::distance(glm::dvec3(rgb(hdr, x, y)), expected), 0.01 * glm::length(expected));
    }
  }
}

}  // namespace
}  // namespace heliograph::test
