#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 64, height = 48;

/// A white rough ground below a square table; tests add the light.
std::shared_ptr<scene::Scene> table_scene() {
  SceneBuilder builder;
  const auto square = [&](float size, float at) {
    return builder.add_quad(
        {{{-size, at, size}, {size, at, size}, {size, at, -size}, {-size, at, -size}}},
        surface(glm::vec3(1.0f)));
  };
  builder.place(square(50.0f, 0.0f)).place(square(0.5f, 1.0f));
  return std::make_shared<scene::Scene>(*builder.build());
}

struct Shadow {
  std::vector<double> mean;
  std::vector<glm::dvec3> positions;  // NaN where the pixel shows the table or the background
};

Shadow trace(const std::shared_ptr<scene::Scene>& scene, std::uint32_t samples) {
  RigOptions options{.extent = {width, height}};
  options.settings.antialiasing.jitter = false;
  const scene::Camera camera = look({0, 0.9f, 3.5f}, {0, 0.0f, 0}, 60.0f);
  FrameRig rig(scene, camera, options);
  const auto gbuffer = render::rasterize_gbuffer(rig.plan(), rig.inputs());
  const auto visibility = render::trace_shadows(rig.plan(), rig.inputs(), gbuffer);
  Shadow shadow{std::vector<double>(width * height, 0.0),
                std::vector<glm::dvec3>(width * height, glm::dvec3(NAN))};
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    rig.set_view(camera, sample);
    rig.run();
    const auto image = rig.read(visibility);
    for (std::size_t i = 0; i < shadow.mean.size(); ++i) {
      shadow.mean[i] += image.rgba[4 * i] / samples;
    }
  }
  const auto motion = rig.read(gbuffer.motion);
  for (std::size_t i = 0; i < shadow.mean.size(); ++i) {
    const float view_z = motion.rgba[4 * i + 3];
    if (view_z <= 0.0f) continue;
    const auto& constants = rig.constants();
    const glm::vec2 ndc =
        (glm::vec2(i % width, i / width) + 0.5f) / glm::vec2(width, height) * 2.0f - 1.0f;
    const glm::vec3 position(constants.inverse_view *
                             glm::vec4(ndc * glm::vec2(constants.unproject) * view_z, -view_z, 1));
    if (std::abs(position.y) < 0.01f && glm::length(position) < 8.0f)
      shadow.positions[i] = position;
  }
  return shadow;
}

bool occluded_by_table(const glm::dvec3& from, const glm::dvec3& to) {
  if (to.y <= 1.0) return false;
  const glm::dvec3 at = from + (to - from) * ((1.0 - from.y) / (to.y - from.y));
  return std::abs(at.x) < 0.5 && std::abs(at.z) < 0.5;
}

/// Fraction of unoccluded diffuse light at `position`, by numerical integration over the light.
double visible_fraction(const glm::dvec3& position, const glm::dvec3& direction,
                        const std::function<glm::dvec3(double, double)>& point) {
  constexpr int strata = 64;
  double lit = 0.0, all = 0.0;
  for (int i = 0; i < strata * strata; ++i) {
    const glm::dvec3 to = point((i % strata + 0.5) / strata, (i / strata + 0.5) / strata);
    const glm::dvec3 offset = to - position;
    const double squared = glm::dot(offset, offset);
    const double weight =
        std::max(-glm::dot(offset, direction), 0.0) * std::max(offset.y, 0.0) / (squared * squared);
    all += weight;
    if (!occluded_by_table(position, to)) lit += weight;
  }
  return all > 0.0 ? lit / all : NAN;
}

void expect_visible_fractions(const Shadow& shadow, const glm::dvec3& direction,
                              const std::function<glm::dvec3(double, double)>& point) {
  double error = 0.0, bias = 0.0;
  int compared = 0, half_lit = 0;
  for (std::size_t i = 0; i < shadow.mean.size(); ++i) {
    if (std::isnan(shadow.positions[i].x)) continue;
    const double expected = visible_fraction(shadow.positions[i], direction, point);
    if (std::isnan(expected)) continue;
    EXPECT_NEAR(shadow.mean[i], expected, 0.2) << shadow.positions[i].x;
    error += std::abs(shadow.mean[i] - expected);
    bias += shadow.mean[i] - expected;
    half_lit += expected > 0.2 && expected < 0.8;
    ++compared;
  }
  ASSERT_GT(compared, 1000);
  EXPECT_GT(half_lit, 50);
  EXPECT_LT(error / compared, 0.015);
  EXPECT_LT(std::abs(bias / compared), 0.005);
}

TEST(AreaShadows, RectangleLightVisibilityMatchesIntegral) {
  const auto scene = table_scene();
  shared::Light light{};
  light.type = shared::light_rectangle;
  light.position = {0.3f, 2.5f, -0.2f};
  light.direction = glm::normalize(glm::vec3(-0.2f, -1, 0.1f));
  light.tangent = glm::normalize(glm::cross(light.direction, glm::vec3(0, 0, 1)));
  light.color = glm::vec3(5.0f);
  light.half_width = 0.9f;
  light.half_height = 0.4f;
  scene->lights.push_back({"panel", light});
  const glm::dvec3 across = glm::cross(light.direction, light.tangent);
  expect_visible_fractions(trace(scene, 128), light.direction, [&](double u, double v) {
    return glm::dvec3(light.position) + (2.0 * u - 1.0) * 0.9 * glm::dvec3(light.tangent) +
           (2.0 * v - 1.0) * 0.4 * across;
  });
}

TEST(AreaShadows, DiskLightVisibilityMatchesIntegral) {
  const auto scene = table_scene();
  shared::Light light{};
  light.type = shared::light_disk;
  light.position = {-0.4f, 2.2f, 0.3f};
  light.direction = {0, -1, 0};
  light.tangent = {1, 0, 0};
  light.color = glm::vec3(5.0f);
  light.radius = 0.7f;
  scene->lights.push_back({"disk", light});
  expect_visible_fractions(trace(scene, 128), light.direction, [&](double u, double v) {
    const double radius = 0.7 * std::sqrt(u), angle = 2.0 * M_PI * v;
    return glm::dvec3(light.position) +
           glm::dvec3(radius * std::cos(angle), 0.0, radius * std::sin(angle));
  });
}

// The disk of a spot light faces the surface; inside the inner cone it shines like a point light.
TEST(AreaShadows, SpotLightShadowIsSoftOnlyWithRadius) {
  for (const float radius : {0.0f, 0.6f}) {
    const auto scene = table_scene();
    shared::Light light{};
    light.type = shared::light_spot;
    light.position = {0, 3, 0};
    light.direction = {0, -1, 0};
    light.color = glm::vec3(5.0f);
    light.radius = radius;
    light.spot_scale = 0.0f;
    light.spot_offset = 1.0f;
    scene->lights.push_back({"spot", light});
    const Shadow shadow = trace(scene, 32);
    int soft = 0, dark = 0;
    for (std::size_t i = 0; i < shadow.mean.size(); ++i) {
      if (std::isnan(shadow.positions[i].x)) continue;
      soft += shadow.mean[i] > 0.02 && shadow.mean[i] < 0.98;
      const glm::dvec2 at(shadow.positions[i].x, shadow.positions[i].z);
      const double reach = std::max(std::abs(at.x), std::abs(at.y));
      // The table's edge casts its shadow at 0.75; the penumbra extends the same distance on both
      // sides.
      const double penumbra = 0.5 * radius + 0.02;
      if (reach < 0.75 - penumbra) {
        EXPECT_EQ(shadow.mean[i], 0.0) << at.x << " " << at.y;
      } else if (reach > 0.75 + penumbra) {
        EXPECT_EQ(shadow.mean[i], 1.0) << at.x << " " << at.y;
      }
      dark += shadow.mean[i] == 0.0;
    }
    EXPECT_GT(dark, 20) << radius;
    EXPECT_TRUE(radius > 0.0f ? soft > 100 : soft == 0) << soft;
  }
}

}  // namespace
}  // namespace heliograph::test
