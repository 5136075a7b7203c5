#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/resources/environment/irradiance.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/brdf_reference.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { irradiance, radiance, reflection, light, material, position };

/// A sky without symmetry: rotated or reflected it is another one.
glm::vec3 smooth_sky(const glm::vec3& d) {
  return {1.0f + 0.5f * d.x + 0.2f * d.y * d.z, 0.8f + 0.4f * d.z - 0.3f * d.x * d.y,
          0.6f + 0.3f * d.y + 0.2f * d.x * d.z};
}

/// `direction` turned by the setting: counter-clockwise about +Y, seen from above.
glm::vec3 turned(const glm::vec3& d, float degrees) {
  const float angle = glm::radians(degrees), c = std::cos(angle), s = std::sin(angle);
  return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

class Environment : public testing::TestWithParam<float> {
 protected:
  Environment() : rig_(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), options(GetParam())) {}

  static RigOptions options(float rotation) {
    RigOptions made;
    made.environment = make_environment(512, smooth_sky);
    made.settings.environment.rotation = rotation;
    made.settings.environment.intensity = 1.5f;
    return made;
  }

  std::vector<glm::vec3> call(Function function, float w) {
    std::vector<ShaderInput> inputs;
    for (const glm::vec3& d : directions_) inputs.push_back({.a = glm::vec4(d, w)});
    std::vector<glm::vec3> result;
    for (const auto& output :
         ShaderFunctions(shaders::frame_functions, &rig_).call(function, inputs)) {
      result.emplace_back(output.x);
    }
    return result;
  }

  static std::vector<glm::vec3> random_directions() {
    std::vector<glm::vec3> made{{0, 1, 0},  {0, -1, 0}, {1, 0, 0},
                                {-1, 0, 0}, {0, 0, 1},  {0, 0, -1}};
    RandomInputs random(3);
    while (made.size() < 3000) made.push_back(random.unit_vector());
    return made;
  }

  FrameRig rig_;
  std::vector<glm::vec3> directions_ = random_directions();
};

TEST_P(Environment, RadianceRotatesWithTheSetting) {
  const auto got = call(radiance, 0.0f);
  for (std::size_t i = 0; i < got.size(); ++i) {
    // What shines from d without rotation shines from the turned d with it.
    const glm::vec3 expected = 1.5f * smooth_sky(turned(directions_[i], -GetParam()));
    EXPECT_LE(glm::distance(got[i], expected), 0.02f) << i;
  }
}

TEST_P(Environment, IrradianceMatchesTheHostsRotatedPolynomial) {
  const auto coefficients = render::project_irradiance(options(0.0f).environment);
  const auto got = call(irradiance, 0.0f);
  for (std::size_t i = 0; i < got.size(); ++i) {
    const glm::vec3 expected =
        1.5f * render::evaluate_irradiance(coefficients, turned(directions_[i], -GetParam()));
    EXPECT_LE(glm::distance(got[i], expected), 1e-4f) << i;
  }
}

TEST_P(Environment, PerfectMirrorReflectsTheUnfilteredEnvironment) {
  const auto got = call(reflection, 0.0f);
  for (std::size_t i = 0; i < got.size(); ++i) {
    const glm::vec3 expected = 1.5f * smooth_sky(turned(directions_[i], -GetParam()));
    EXPECT_LE(glm::distance(got[i], expected), 0.02f) << i;
  }
}

// The widest GGX lobe about r with n = v = r, weighted by n.l, is between a mirror and Lambert.
TEST_P(Environment, RoughReflectionsBlurTowardTheMean) {
  const auto sharp = call(reflection, 0.0f), rough = call(reflection, 1.0f);
  const glm::vec3 mean = 1.5f * glm::vec3(1.0f, 0.8f, 0.6f);
  double sharp_contrast = 0.0, rough_contrast = 0.0;
  glm::dvec3 rough_mean(0.0);
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    sharp_contrast += glm::distance(sharp[i], mean);
    rough_contrast += glm::distance(rough[i], mean);
    rough_mean += glm::dvec3(rough[i]) / static_cast<double>(rough.size());
  }
  EXPECT_LT(rough_contrast, 0.85 * sharp_contrast);
  EXPECT_GT(rough_contrast, 0.3 * sharp_contrast);
  EXPECT_LE(glm::distance(glm::vec3(rough_mean), mean), 0.04f);
}

INSTANTIATE_TEST_SUITE_P(Rotations, Environment, testing::Values(0.0f, 90.0f, -35.0f));

TEST(Lights, FollowKhrLightsPunctual) {
  SceneBuilder builder;
  builder.add_sun({1, -2, 0.5f}, {3, 2, 1}).add_point_light({1, 2, 3}, {10, 20, 30});
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  scene::Light spot = scene->lights[1];
  const double inner = std::cos(glm::radians(20.0)), outer = std::cos(glm::radians(35.0));
  spot.device.type = shared::light_spot;
  spot.device.range = 8.0f;
  spot.device.direction = glm::normalize(glm::vec3(-1, -2, -3));
  spot.device.spot_scale = static_cast<float>(1.0 / (inner - outer));
  spot.device.spot_offset = static_cast<float>(-outer / (inner - outer));
  scene->lights.push_back(spot);
  FrameRig rig(scene, look({0, 0, 3}, {0, 0, 0}));

  RandomInputs random(4);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 6000; ++i) {
    inputs.push_back({.a = glm::vec4(static_cast<float>(i % 3)),
                      .b = glm::vec4(random.unit_vector() * random.uniform(0, 6), 0.0f)});
  }
  const auto got = ShaderFunctions(shaders::frame_functions, &rig).call(light, inputs);
  int lit_by_spot = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec3 direction(got[i].x), shining(got[i].y);
    if (i % 3 == 0) {
      EXPECT_LE(glm::distance(direction, glm::normalize(glm::vec3(-1, 2, -0.5f))), 1e-6f);
      EXPECT_EQ(shining, glm::vec3(3, 2, 1));
      continue;
    }
    const glm::dvec3 to_light = glm::dvec3(1, 2, 3) - glm::dvec3(inputs[i].b);
    const double distance = glm::length(to_light);
    double expected = 10.0 / (distance * distance);
    if (i % 3 == 2) {
      const double window = std::clamp(1.0 - std::pow(distance / 8.0, 4.0), 0.0, 1.0);
      const double cosine = glm::dot(glm::dvec3(spot.device.direction), -to_light / distance);
      const double cone = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
      expected *= window * cone * cone;
      lit_by_spot += expected > 0.0;
    }
    EXPECT_NEAR(got[i].x.w, distance, 1e-5 * distance);
    EXPECT_LE(glm::distance(glm::dvec3(direction), to_light / distance), 1e-5);
    EXPECT_NEAR(shining.x, expected, 2e-4 * expected + 1e-5);
    EXPECT_NEAR(shining.z, 3.0 * expected, 6e-4 * expected + 3e-5);
  }
  EXPECT_GT(lit_by_spot, 100);
}

/// A pixel's world position projects back to the jittered pixel: the inverse of the rasteriser's
/// projection.
void expect_round_trip(const scene::Camera& camera, std::uint32_t sample) {
  RigOptions options;
  options.extent = {64, 36};
  FrameRig rig(SceneBuilder().build(), camera, options);
  rig.set_view(camera, sample);
  RandomInputs random(5);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 2000; ++i) {
    inputs.push_back({.a = {std::floor(random.uniform(0, 64)), std::floor(random.uniform(0, 36)),
                            random.uniform(0.1f, 50.0f), 0.0f}});
  }
  const auto got = ShaderFunctions(shaders::frame_functions, &rig).call(position, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec4 world(glm::vec3(got[i].x), 1.0f);
    const glm::vec4 clip = rig.constants().view_projection * world;
    const glm::vec2 pixel = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(64, 36);
    EXPECT_LE(glm::distance(pixel, glm::vec2(inputs[i].a) + 0.5f), 2e-3f) << i;
    EXPECT_NEAR(-(rig.constants().view * world).z, inputs[i].a.z, 1e-5f * (10.0f + inputs[i].a.z));
    const glm::vec3 to_eye(got[i].y);
    EXPECT_NEAR(glm::length(to_eye), 1.0f, 1e-5f);
    const glm::vec3 expected = camera.orthographic_height > 0.0f
                                   ? glm::normalize(camera.eye - camera.target)
                                   : glm::normalize(camera.eye - glm::vec3(world));
    EXPECT_LE(glm::distance(to_eye, expected), 1e-3f);
  }
}

TEST(WorldPosition, IsTheInverseOfProjection) {
  const scene::Camera camera = look({1, 2, 5}, {0.5f, 0.3f, -1}, 50.0f);
  expect_round_trip(camera, 0);
  expect_round_trip(camera, 7);
}

TEST(WorldPosition, IsTheInverseOfOrthographicProjection) {
  scene::Camera camera = look({1, 2, 5}, {0.5f, 0.3f, -1});
  camera.orthographic_height = 4.0f;
  camera.far_plane = 100.0f;
  expect_round_trip(camera, 0);
  expect_round_trip(camera, 7);
}

TEST(Material, AlbedosOfWhiteSumToOne) {
  const FrameRig rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}));
  std::vector<ShaderInput> inputs;
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.6f, 1.0f}) {
      for (const float cosine : {1.0f, 0.7f, 0.3f, 0.1f, 0.02f}) {
        inputs.push_back({.a = {metallic, roughness, cosine, 0}});
      }
    }
  }
  const auto got = ShaderFunctions(shaders::frame_functions, &rig).call(material, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    EXPECT_NEAR(got[i].x.x + got[i].y.x, 1.0f, 1e-5f) << i;
    if (inputs[i].a.x > 0.0f) continue;
    // The dielectric's own part against the integral: the table is interpolated.
    const glm::dvec2 split = split_sum_reference(inputs[i].a.z, inputs[i].a.y);
    const double regained = 1.0 / (split.x + split.y) - 1.0;
    const double expected = (0.04 * split.x + split.y) * (1.0 + 0.04 * regained);
    EXPECT_NEAR(got[i].x.x, expected, 0.01)
        << "roughness " << inputs[i].a.y << ", cosine " << inputs[i].a.z;
  }
}

}  // namespace
}  // namespace heliograph::test
