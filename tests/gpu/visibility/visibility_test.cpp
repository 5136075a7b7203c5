#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "render/passes/visibility/trace_visibility.hpp"
#include "tests/gpu/support/uniform_gbuffer.hpp"

namespace heliograph::test {
namespace {

glm::vec3 decode(const glm::vec2& p) {
  glm::vec3 d(p.x, p.y, 1.0f - std::abs(p.x) - std::abs(p.y));
  const float below = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -below : below;
  d.y += d.y >= 0.0f ? -below : below;
  return glm::normalize(d);
}

/// Rasterizes a scene, traces shadows or ambient visibility and averages over samples.
struct Trace {
  Trace(SceneBuilder& builder, const scene::Camera& view, const std::string& tracer,
        const protocol::Settings& settings = without_indirect(), bool ambient = false)
      : camera(view),
        rig(builder.build(), view, options(tracer, settings)),
        gbuffer(render::rasterize_gbuffer(rig.plan(), rig.inputs())),
        visibility(ambient ? render::trace_ambient(rig.plan(), rig.inputs(), gbuffer)
                           : render::trace_shadows(rig.plan(), rig.inputs(), gbuffer)) {}

  static RigOptions options(const std::string& tracer, protocol::Settings settings) {
    settings.antialiasing.jitter = false;
    return {.extent = {64, 48}, .settings = settings, .tracer = tracer};
  }

  void run(std::uint32_t samples) {
    mean.assign(64 * 48, 0.0);
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
      rig.set_view(camera, sample);
      rig.run();
      const auto image = rig.read(visibility);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += image.rgba[4 * i] / samples;
    }
    normals = rig.read(gbuffer.normals);
    motion = rig.read(gbuffer.motion);
  }
  bool covered(std::size_t i) const { return motion.rgba[4 * i + 3] > 0.0f; }
  glm::vec3 world(std::size_t i) const {
    const auto& constants = rig.constants();
    const glm::vec2 ndc = (glm::vec2(i % 64, i / 64) + 0.5f) / glm::vec2(64, 48) * 2.0f - 1.0f;
    const float view_z = motion.rgba[4 * i + 3];
    return glm::vec3(constants.inverse_view *
                     glm::vec4(ndc * glm::vec2(constants.unproject) * view_z, -view_z, 1.0f));
  }

  scene::Camera camera;
  FrameRig rig;
  render::GBuffer gbuffer;
  gpu::ImageRef visibility;
  std::vector<double> mean;
  render::FloatImage normals, motion;
};

std::uint32_t add_ground(SceneBuilder& builder, float size, float height = 0.0f) {
  return builder.add_quad({{{-size, height, size},
                            {size, height, size},
                            {size, height, -size},
                            {-size, height, -size}}},
                          surface(glm::vec3(1.0f)));
}

/// A roof at `height` that covers x < 0.
std::uint32_t add_roof(SceneBuilder& builder, float height) {
  return builder.add_quad(
      {{{-50, height, 50}, {0, height, 50}, {0, height, -50}, {-50, height, -50}}},
      surface(glm::vec3(1.0f)));
}

class Shadows : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << unsupported_reason(GetParam());
  }
};

// Overhead sun past a straight edge: the uncovered fraction of its disk.
TEST_P(Shadows, PenumbraMatchesAnalyticSunDisk) {
  constexpr float height = 2.0f, diameter = 20.0f;
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, height));
  builder.add_sun({0, -1, 0}, glm::vec3(1.0f), diameter);
  Trace trace(builder, look({0, 1.5f, 2}, {0, 0, 0}), GetParam());
  trace.run(128);
  const double radius = height * std::tan(glm::radians(0.5 * diameter));
  double error = 0.0;
  int compared = 0, half_lit = 0;
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i)) continue;
    const double x = std::clamp(trace.world(i).x / radius, -1.0, 1.0);
    const double expected = 1.0 - (std::acos(x) - x * std::sqrt(1.0 - x * x)) / std::numbers::pi;
    error += std::abs(trace.mean[i] - expected);
    ASSERT_NEAR(trace.mean[i], expected, 0.12) << trace.world(i).x;
    ++compared;
    half_lit += expected > 0.3 && expected < 0.7;
  }
  EXPECT_GT(half_lit, 50);
  EXPECT_LT(error / compared, 0.012);
}

TEST_P(Shadows, SunWithoutDiameterCastsHardShadow) {
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, 2.0f));
  builder.add_sun({0.5f, -1, 0}, glm::vec3(1.0f), 0.0f);
  Trace trace(builder, look({1, 1.5f, 2}, {1, 0, 0}), GetParam());
  trace.run(2);
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i)) continue;
    const float x = trace.world(i).x;
    if (std::abs(x - 1.0f) < 1e-3f) continue;
    ASSERT_EQ(trace.mean[i], x > 1.0f ? 1.0 : 0.0) << x;
  }
}

TEST_P(Shadows, AngularDiameterOverrideReplacesSunDiameter) {
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, 2.0f));
  builder.add_sun({0, -1, 0}, glm::vec3(1.0f), 20.0f);
  protocol::Settings settings = without_indirect();
  settings.shadows.angular_diameter_override = 0.0f;
  Trace trace(builder, look({0, 1.5f, 2}, {0, 0, 0}), GetParam(), settings);
  trace.run(2);
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i)) continue;
    ASSERT_TRUE(trace.mean[i] == 0.0 || trace.mean[i] == 1.0) << i;
  }
}

// Heitz et al. 2018: the expectation is sum(L V) / sum(L).
TEST_P(Shadows, MultipleLightsConvergeToShadowRatio) {
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, 2.0f));
  builder.add_sun({0, -1, 0}, glm::vec3(1.0f));
  builder.add_sun({-1, -1, 0}, glm::vec3(3.0f));
  builder.add_point_light({0.5f, 1.0f, 0}, glm::vec3(0.8f));
  Trace trace(builder, look({-0.5f, 1.5f, 2}, {-0.5f, 0, 0}), GetParam());
  trace.run(256);
  int compared = 0, mixed = 0;
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i)) continue;
    const glm::dvec3 p = trace.world(i);
    // The roof shadows x < 0 from the first sun and x < -2 from the second, which comes from +x.
    if (std::abs(p.x) < 1e-3 || std::abs(p.x + 2.0) < 1e-3) continue;
    const glm::dvec3 to_light = glm::dvec3(0.5, 1.0, 0.0) - p;
    const double squared = glm::dot(to_light, to_light);
    const double light = 0.8 / squared * to_light.y / std::sqrt(squared);
    const double above = 1.0, aslant = 3.0 * std::sqrt(0.5);
    const double lit = (p.x > 0.0 ? above : 0.0) + (p.x > -2.0 ? aslant : 0.0) + light;
    ASSERT_NEAR(trace.mean[i], lit / (above + aslant + light), 0.05) << p.x;
    ++compared;
    mixed += p.x < 0.0;
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(mixed, 500);
}

TEST_P(Shadows, SphereLightCastsPenumbra) {
  constexpr double light_height = 3.0, roof_height = 1.0, light_radius = 0.5;
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, roof_height));
  builder.add_point_light({0, light_height, 0}, glm::vec3(10.0f), light_radius);
  Trace trace(builder, look({0, 0.9f, 1.5f}, {0, 0, 0}), GetParam());
  trace.run(64);
  // Below the light half of its disk is hidden; the penumbra is the disk projected past the edge.
  const double half_width = light_radius * roof_height / (light_height - roof_height);
  int full = 0, none = 0, half = 0;
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i) || std::abs(trace.world(i).z) > 0.3f) continue;
    const double x = trace.world(i).x;
    if (x > 1.1 * half_width && x < 1.0) {
      EXPECT_GT(trace.mean[i], 0.99) << x;
      ++full;
    } else if (x < -1.1 * half_width && x > -1.0) {
      EXPECT_LT(trace.mean[i], 0.01) << x;
      ++none;
    } else if (std::abs(x) < 0.02) {
      EXPECT_NEAR(trace.mean[i], 0.5, 0.15) << x;
      ++half;
    }
  }
  EXPECT_GT(full, 20);
  EXPECT_GT(none, 20);
  EXPECT_GT(half, 2);
}

/// Expects every pixel of a convex mesh that faces the light to be lit: no self-intersection.
void expect_no_acne(SceneBuilder& builder, const scene::Camera& camera, const glm::vec3& to_sun,
                    const std::string& tracer, const std::string& what) {
  builder.add_sun(-to_sun, glm::vec3(1.0f));
  Trace trace(builder, camera, tracer);
  trace.run(1);
  int tested = 0, dark = 0;
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    if (!trace.covered(i)) continue;
    const float* encoded = &trace.normals.rgba[4 * i];
    if (glm::dot(decode({encoded[0], encoded[1]}), to_sun) < 0.03f) continue;
    if (glm::dot(decode({encoded[2], encoded[3]}), to_sun) < 0.03f) continue;
    ++tested;
    dark += trace.mean[i] < 1.0;
  }
  EXPECT_GT(tested, 300) << what;
  EXPECT_EQ(dark, 0) << what << ": of " << tested << " pixels";
}

TEST_P(Shadows, ConvexMeshesHaveNoShadowAcneAtAnyScale) {
  for (const float scale : {1e-3f, 1e-2f, 1.0f, 10.0f, 100.0f, 1e3f, 1e4f}) {
    SceneBuilder builder;
    builder.place(builder.add_sphere(scale, surface(glm::vec3(1.0f))));
    scene::Camera camera = look(scale * glm::vec3(1, 1.5f, 3), {0, 0, 0});
    camera.near_plane = 0.01f * scale;
    expect_no_acne(builder, camera, glm::normalize(glm::vec3(0.3f, 1, 0.5f)), GetParam(),
                   "sphere of radius " + std::to_string(scale));
  }
}

TEST_P(Shadows, GroundHasNoShadowAcneFarFromCamera) {
  for (const float height : {0.0f, 1e-4f, 0.033f, 0.5f, 3.0f, -0.04f}) {
    for (const float distance : {2.0f, 20.0f, 200.0f}) {
      SceneBuilder builder;
      builder.place(add_ground(builder, 1e3f, height));
      const glm::vec3 center(7, height, 3);
      expect_no_acne(builder, look(distance * glm::vec3(0.4f, 0.3f, 1) + center, center),
                     glm::normalize(glm::vec3(0.3f, 1, 0.2f)), GetParam(),
                     "ground at " + std::to_string(height) + " from " + std::to_string(distance));
    }
  }
}

TEST_P(Shadows, AmbientVisibilityIsCosineWeightedSky) {
  constexpr float height = 0.5f;
  SceneBuilder builder;
  builder.place(add_ground(builder, 50)).place(add_roof(builder, height));
  protocol::Settings settings = without_indirect();
  settings.ambient.radius = 100.0f;
  Trace trace(builder, look({0, 0.45f, 0.8f}, {0, 0, 0}), GetParam(), settings, true);
  trace.run(128);
  double error = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < trace.mean.size(); ++i) {
    const glm::vec3 p = trace.covered(i) ? trace.world(i) : glm::vec3(99.0f);
    if (std::abs(p.x) > 4.0f || std::abs(p.z) > 4.0f) continue;
    // The sky is open beyond the elevation of the roof's edge: (1 + sin(elevation)) / 2.
    const double expected = 0.5 * (1.0 + p.x / std::hypot(p.x, height));
    error += std::abs(trace.mean[i] - expected);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(error / compared, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Tracers, Shadows, testing::Values("embree", "software"),
                         [](const testing::TestParamInfo<std::string>& tracer) {
                           return tracer.param;
                         });

}  // namespace
}  // namespace heliograph::test
