#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/generator/scenes/test_scenes.hpp"
#include "scenes/generator/sky/sky.hpp"
#include "tests/image/support/renderer_rig.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t mirror_width = 240, mirror_height = 180;
constexpr glm::dvec3 center(0.0, 0.45, 0.0);
constexpr double radius = 0.45;

/// Bilinear lookup; wraps in longitude and clamps at the poles.
glm::dvec3 sample_environment(const scene::Environment& sky, const glm::dvec3& d) {
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

/// World direction through a pixel's center.
glm::dvec3 view_ray(const scene::Camera& camera, std::uint32_t x, std::uint32_t y) {
  const double slope = std::tan(glm::radians(0.5 * camera.vertical_fov));
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target - camera.eye));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right, forward);
  return glm::normalize(
      forward +
      right * (slope * mirror_width / mirror_height * ((x + 0.5) / mirror_width * 2.0 - 1.0)) -
      up * (slope * ((y + 0.5) / mirror_height * 2.0 - 1.0)));
}

struct Errors {
  double median = 0.0, largest = 0.0;  // relative to the expected radiance
  int pixels = 0;
};

/// Compares every pixel of the mirror sphere with the environment in the reflected direction.
Errors reflection_errors(const scene::Environment& sky, float rotation, bool traced,
                         const std::string& name) {
  const auto scene =
      std::make_shared<const scene::Scene>(import_generated(scenes::make_mirror(), 16));
  const scene::Camera camera = scene->cameras.at(0);
  RendererRig rig(scene, sky, camera, mirror_width, mirror_height);
  protocol::Settings settings;
  settings.ambient.occlusion = settings.indirect.enabled = false;  // of the environment alone
  settings.antialiasing.jitter = settings.antialiasing.temporal = false;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.specular.enabled = traced;
  settings.environment.rotation = rotation;
  rig.apply(settings);
  save_image(name + (traced ? "_traced" : "_prefiltered"), rig.accumulate(1));
  const render::FloatImage hdr = rig.capture("hdr");
  const double angle = glm::radians(-static_cast<double>(rotation));
  std::vector<double> errors;
  for (std::uint32_t y = 0; y < mirror_height; ++y) {
    for (std::uint32_t x = 0; x < mirror_width; ++x) {
      const glm::dvec3 ray = view_ray(camera, x, y);
      const glm::dvec3 to_eye = glm::dvec3(camera.eye) - center;
      const double b = glm::dot(to_eye, ray), c = glm::dot(to_eye, to_eye) - radius * radius;
      if (b * b <= c) continue;
      const glm::dvec3 normal = (to_eye + ray * (-b - std::sqrt(b * b - c))) / radius;
      if (-glm::dot(normal, ray) < 0.25) continue;  // triangles are visible at the silhouette
      const glm::dvec3 r = glm::reflect(ray, normal);
      if (traced && r.y < 0.05) continue;  // reflects the ground
      const glm::dvec3 rotated(std::cos(angle) * r.x + std::sin(angle) * r.z, r.y,
                               std::cos(angle) * r.z - std::sin(angle) * r.x);
      const glm::dvec3 expected = sample_environment(sky, rotated);
      errors.push_back(glm::distance(glm::dvec3(rgb(hdr, x, y)), expected) / glm::length(expected));
    }
  }
  std::sort(errors.begin(), errors.end());
  return {errors.at(errors.size() / 2), errors.back(), static_cast<int>(errors.size())};
}

// For the prefiltered environment and for traced reflections.
class Mirror : public testing::TestWithParam<bool> {};

TEST_P(Mirror, ReflectsGeneratedSky) {
  const auto sky = scenes::make_clear_sky(scenes::direction_to_sun(50.0f, 30.0f), 512, 256);
  const Errors errors =
      reflection_errors(import_generated(sky.environment), 0.0f, GetParam(), "mirror_sky");
  EXPECT_GT(errors.pixels, GetParam() ? 1500 : 2000);
  EXPECT_LT(errors.median, GetParam() ? 0.002 : 0.01);
  EXPECT_LT(errors.largest,
            GetParam() ? 0.05 : 0.15);  // at the horizon, which is sharper than the cube map
}

/// A different color along each axis and a red spot: reveals flips and rotations.
glm::vec3 colored_sky(const glm::vec3& d) {
  const glm::vec3 glow = glm::normalize(glm::vec3(0.8f, 0.5f, 0.6f));
  return glm::vec3(1.0f) + 0.6f * d +
         glm::vec3(8, 0, 0) * std::pow(std::max(glm::dot(d, glow), 0.0f), 40.0f);
}

TEST_P(Mirror, ReflectsColoredSkyInCorrectOrientation) {
  const Errors errors =
      reflection_errors(make_environment(512, colored_sky), 0.0f, GetParam(), "mirror_colored");
  EXPECT_LT(errors.median, GetParam() ? 0.001 : 0.005);
  EXPECT_LT(errors.largest, GetParam() ? 0.02 : 0.05);
}

TEST_P(Mirror, RotatesWithEnvironment) {
  const Errors errors =
      reflection_errors(make_environment(512, colored_sky), 70.0f, GetParam(), "mirror_rotated");
  EXPECT_LT(errors.median, GetParam() ? 0.001 : 0.005);
  EXPECT_LT(errors.largest, GetParam() ? 0.02 : 0.05);
}

std::string method_name(const testing::TestParamInfo<bool>& method) {
  return method.param ? "traced" : "prefiltered";
}

INSTANTIATE_TEST_SUITE_P(Methods, Mirror, testing::Bool(), method_name);

TEST(Background, ShowsEnvironmentBehindEveryPixel) {
  const scene::Environment sky = make_environment(512, colored_sky);
  const scene::Camera camera = look({0, 0, 0}, {1, 0.3f, 0.8f}, 60.0f);
  RendererRig rig(SceneBuilder().build(), sky, camera, mirror_width, mirror_height);
  protocol::Settings settings;
  settings.antialiasing.jitter = false;
  rig.apply(settings);
  save_image("background", rig.accumulate(1));
  const render::FloatImage hdr = rig.capture("hdr");
  for (std::uint32_t y = 0; y < mirror_height; y += 3) {
    for (std::uint32_t x = 0; x < mirror_width; x += 3) {
      const glm::dvec3 expected = sample_environment(sky, view_ray(camera, x, y));
      ASSERT_LE(glm::distance(glm::dvec3(rgb(hdr, x, y)), expected), 0.01 * glm::length(expected));
    }
  }
}

}  // namespace
}  // namespace heliograph::test
