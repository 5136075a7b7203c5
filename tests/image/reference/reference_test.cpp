#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/import.hpp"
#include "tests/image/support/renderer_rig.hpp"
#include "tests/support/brdf_reference.hpp"

namespace heliograph::test {
namespace {

using protocol::ReferenceScope;
using protocol::ReferenceUse;

/// The hybrid without denoising: the mean over all samples.
protocol::Settings traced(ReferenceScope scope) {
  protocol::Settings settings = undenoised();
  settings.reference.use = ReferenceUse::always;
  settings.reference.scope = scope;
  return settings;
}

/// Mean luminance of the accumulated image after `samples` samples.
double mean_luminance(RendererRig& rig, const protocol::Settings& settings, std::uint32_t samples,
                      const std::string& name) {
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  const render::FloatImage radiance = rig.capture("accumulated");
  double sum = 0.0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    const double luminance =
        0.2126 * radiance.rgba[i] + 0.7152 * radiance.rgba[i + 1] + 0.0722 * radiance.rgba[i + 2];
    EXPECT_TRUE(std::isfinite(luminance));
    sum += luminance;
  }
  return sum / (static_cast<double>(radiance.rgba.size()) / 4.0);
}

glm::vec3 reference_sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

/// Metal and dielectric spheres of one roughness on a floor, with shadows and interreflections.
std::shared_ptr<const scene::Scene> reference_scene(float roughness) {
  SceneBuilder builder;
  const auto floor = builder.add_quad({{{-6, 0, 4}, {6, 0, 4}, {6, 0, -6}, {-6, 0, -6}}},
                                      surface({0.6f, 0.5f, 0.4f}, roughness, 0.0f));
  const auto wall = builder.add_quad({{{-6, 0, -3}, {6, 0, -3}, {6, 4, -3}, {-6, 4, -3}}},
                                     surface({0.4f, 0.5f, 0.6f}, roughness, 0.5f));
  shared::Material glowing = surface({0.2f, 0.2f, 0.2f}, roughness, 0.0f);
  glowing.emissive = {1.5f, 1.0f, 0.5f};
  const auto metal = builder.add_sphere(0.7f, surface({0.9f, 0.7f, 0.5f}, roughness, 1.0f));
  const auto plastic = builder.add_sphere(0.6f, surface({0.1f, 0.6f, 0.2f}, roughness, 0.0f));
  const auto glowing_sphere = builder.add_sphere(0.3f, glowing);
  const auto at = [](float x, float y, float z) {
    return glm::translate(glm::mat4(1.0f), glm::vec3(x, y, z));
  };
  builder.place(floor).place(wall);
  builder.place(metal, at(-1, 0.7f, 0)).place(plastic, at(0.8f, 0.6f, 0.4f));
  builder.place(glowing_sphere, at(0, 0.3f, 1.2f));
  builder.add_sun({0.5f, -1, -0.4f}, {3.0f, 2.8f, 2.4f}).add_point_light({2, 2, 1}, {4, 3, 2});
  return builder.build();
}

struct Case {
  float roughness;
  float angle;  // angular diameter of the sun in degrees
};

class SamePaths : public testing::TestWithParam<Case> {};

TEST_P(SamePaths, HybridConvergesToReference) {
  const auto [roughness, angle] = GetParam();
  RendererRig rig(reference_scene(roughness), make_environment(128, reference_sky),
                  look({0, 2, 6}, {0, 0.7f, 0}), 96, 54);
  protocol::Settings hybrid = undenoised();
  protocol::Settings reference = traced(ReferenceScope::same_paths);
  hybrid.shadows.angular_diameter_override = reference.shadows.angular_diameter_override = angle;
  const std::string name = "same_paths_" + std::to_string(static_cast<int>(100 * roughness)) + "_" +
                           std::to_string(static_cast<int>(angle));
  const double got = mean_luminance(rig, hybrid, 64, name + "_hybrid");
  const double expected = mean_luminance(rig, reference, 64, name + "_reference");
  EXPECT_NEAR(got / expected, 1.0, 0.01) << "roughness " << roughness << ", angle " << angle;
}

INSTANTIATE_TEST_SUITE_P(Roughness, SamePaths,
                         testing::Values(Case{0.0f, 2.0f}, Case{0.1f, 2.0f}, Case{0.2f, 2.0f},
                                         Case{0.3f, 2.0f}, Case{0.4f, 2.0f}, Case{0.6f, 2.0f},
                                         Case{1.0f, 2.0f}));
INSTANTIATE_TEST_SUITE_P(Angle, SamePaths,
                         testing::Values(Case{0.3f, 0.0f}, Case{0.3f, 6.0f}, Case{0.3f, 10.0f}));

// Every lighting switch removes the same light from hybrid and reference.
TEST(SamePaths, LightingSwitchesMatchHybrid) {
  RendererRig rig(reference_scene(0.3f), make_environment(128, reference_sky),
                  look({0, 2, 6}, {0, 0.7f, 0}), 96, 54);
  using Change = void (*)(protocol::Settings&);
  const std::vector<Change> changes{
      [](protocol::Settings& s) { s.lighting.direct = false; },
      [](protocol::Settings& s) { s.lighting.environment_diffuse = false; },
      [](protocol::Settings& s) { s.lighting.environment_specular = false; },
      [](protocol::Settings& s) { s.ambient.occlusion = false; },
      [](protocol::Settings& s) { s.shadows.enabled = false; },
      [](protocol::Settings& s) { s.specular.enabled = false; },
      [](protocol::Settings& s) { s.specular.hit_shading = protocol::HitShading::environment; },
      [](protocol::Settings& s) { s.environment.visible = false; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    protocol::Settings hybrid = undenoised();
    protocol::Settings reference = traced(ReferenceScope::same_paths);
    changes[i](hybrid);
    changes[i](reference);
    const double got = mean_luminance(rig, hybrid, 16, "switch_hybrid");
    const double expected = mean_luminance(rig, reference, 16, "switch_reference");
    EXPECT_NEAR(got / expected, 1.0, 0.015) << "switch " << i;
  }
}

class PaperScenes : public testing::TestWithParam<const char*> {};

TEST_P(PaperScenes, HybridConvergesToReference) {
  const auto file = asset(std::string("standins/") + GetParam() + ".glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  ASSERT_FALSE(scene->cameras.empty());
  RendererRig rig(scene, make_environment(128, reference_sky), scene->cameras.at(0), 160, 90);
  const double got = mean_luminance(rig, undenoised(), 32, std::string(GetParam()) + "_hybrid");
  const double expected = mean_luminance(rig, traced(ReferenceScope::same_paths), 32,
                                         std::string(GetParam()) + "_reference");
  EXPECT_NEAR(got / expected, 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Paper, PaperScenes, testing::Values("cubes_distance", "pillars"));

// White surfaces in a white furnace lose no energy over any number of bounces.
TEST(FullReference, WhiteFurnaceStaysWhite) {
  SceneBuilder builder;
  for (int i = 0; i < 10; ++i) {
    const float roughness = 0.25f * static_cast<float>(i % 5);
    const float metallic = i < 5 ? 0.0f : 1.0f;
    const glm::vec3 position(static_cast<float>(i % 5) - 2.0f, i < 5 ? 0.5f : -0.5f, 0);
    builder.place(builder.add_sphere(0.45f, surface(glm::vec3(1.0f), roughness, metallic)),
                  glm::translate(glm::mat4(1.0f), position));
  }
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 160, 64);
  protocol::Settings settings = traced(ReferenceScope::full);
  settings.reference.bounces = 12;
  rig.apply(settings);
  save_image("reference_furnace", rig.accumulate(32));
  const render::FloatImage radiance = rig.capture("accumulated");
  // Block means, because single pixels are noisy.
  for (std::uint32_t y = 0; y < 64; y += 16) {
    for (std::uint32_t x = 0; x < 160; x += 16) {
      glm::vec3 sum(0.0f);
      for (std::uint32_t i = 0; i < 256; ++i) sum += rgb(radiance, x + i % 16, y + i / 16);
      EXPECT_NEAR(sum.x / 256.0f, 1.0f, 0.02f) << x << " " << y;
    }
  }
}

class BothScopes : public testing::TestWithParam<ReferenceScope> {};

TEST_P(BothScopes, SunOnFloorIsAnalytic) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface(glm::vec3(0.5f), 1.0f)));
  const glm::vec3 toward_sun = glm::normalize(glm::vec3(0.6f, 1.0f, 0.2f));
  builder.add_sun(-toward_sun, glm::vec3(3.0f));
  scene::Camera camera = look({0, 5, 0}, {0, 0, 0});
  camera.up = {0, 0, -1};
  camera.orthographic_height = 2.0f;
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)), camera, 16, 16);
  rig.apply(traced(GetParam()));
  rig.accumulate(4);
  const double expected = 3.0 * shade_light_reference(0.5, 0.0, 1.0, {0, 0, 1},
                                                      {toward_sun.x, toward_sun.z, toward_sun.y});
  EXPECT_NEAR(rgb(rig.capture("accumulated"), 8, 8).x, expected, 0.005 * expected);
}

TEST_P(BothScopes, MirrorShowsEmitterUnchanged) {
  SceneBuilder builder;
  shared::Material emitter = surface(glm::vec3(0.0f), 1.0f, 1.0f);
  emitter.emissive = {2.0f, 1.0f, 0.5f};
  emitter.flags = shared::material_double_sided;
  builder.place(builder.add_quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                                 surface(glm::vec3(1.0f), 0.0f, 1.0f)),
                glm::rotate(glm::mat4(1.0f), -0.7853982f, glm::vec3(1, 0, 0)));
  builder.place(builder.add_quad({{{-9, 6, 9}, {9, 6, 9}, {9, 6, -9}, {-9, 6, -9}}}, emitter));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 5}, {0, 0, 0}, 20.0f), 16, 16);
  rig.apply(traced(GetParam()));
  rig.accumulate(4);
  const glm::vec3 seen = rgb(rig.capture("accumulated"), 8, 8);
  EXPECT_LE(glm::distance(seen, glm::vec3(2.0f, 1.0f, 0.5f)), 0.01f);
}

TEST_P(BothScopes, BlendedSurfacesCoverByAlpha) {
  SceneBuilder builder;
  shared::Material translucent = surface({0.8f, 0.4f, 0.2f});
  translucent.base_color.w = 0.25f;
  translucent.flags = shared::material_alpha_blend | shared::material_unlit;
  const auto quad =
      builder.add_quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, translucent);
  builder.place(quad).place(quad, glm::translate(glm::mat4(1.0f), {0, 0, -1}));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 4}, {0, 0, 0}, 20.0f), 32, 32);
  const double got = mean_luminance(rig, traced(GetParam()), 32, "blended");
  const double pane = 0.2126 * 0.8 + 0.7152 * 0.4 + 0.0722 * 0.2;
  EXPECT_NEAR(got, (0.25 + 0.75 * 0.25) * pane + 0.75 * 0.75, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Scopes, BothScopes,
                         testing::Values(ReferenceScope::same_paths, ReferenceScope::full));

TEST(FullReference, IncludesInterreflections) {
  SceneBuilder builder;
  const shared::Material white = surface(glm::vec3(0.8f));
  builder.place(builder.add_quad({{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}}, white));
  builder.place(builder.add_quad({{{-2, 0, -2}, {2, 0, -2}, {2, 4, -2}, {-2, 4, -2}}}, white));
  builder.place(builder.add_quad({{{-2, 0, 2}, {-2, 0, -2}, {-2, 4, -2}, {-2, 4, 2}}}, white));
  builder.add_sun({0.2f, -1, -0.3f}, glm::vec3(3.0f));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({4, 3, 6}, {0, 1, 0}, 40.0f), 64, 36);
  const double same =
      mean_luminance(rig, traced(ReferenceScope::same_paths), 32, "corner_same_paths");
  protocol::Settings settings = traced(ReferenceScope::full);
  settings.reference.bounces = 1;
  const double one = mean_luminance(rig, settings, 32, "corner_one_bounce");
  settings.reference.bounces = 8;
  const double eight = mean_luminance(rig, settings, 32, "corner_full");
  EXPECT_GT(one, 1.05 * same);
  EXPECT_GT(eight, 1.02 * one);
  EXPECT_LT(eight, 2.0 * same);
}

TEST(FullReference, TracersAgree) {
  std::vector<double> mean;
  for (const std::string& tracer : supported_tracers()) {
    RendererRig rig(reference_scene(0.3f), make_environment(128, reference_sky),
                    look({0, 2, 6}, {0, 0.7f, 0}), 48, 27, tracer);
    mean.push_back(mean_luminance(rig, traced(ReferenceScope::full), 8, "traced_by_" + tracer));
  }
  for (const double other : mean) EXPECT_NEAR(other / mean[0], 1.0, 1e-3);
}

/// A static view of the hybrid that the full reference takes over after `hybrid` samples.
protocol::Settings taken_over(int hybrid, int traced_samples) {
  protocol::Settings settings;
  settings.reference.use = ReferenceUse::when_static;
  settings.reference.scope = ReferenceScope::full;
  settings.reference.samples = traced_samples;
  settings.accumulation.max_samples = hybrid;
  return settings;
}

class ReferenceWhenStatic : public testing::Test {
 protected:
  RendererRig rig_{reference_scene(0.4f), make_environment(128, reference_sky),
                   look({0, 2, 6}, {0, 0.7f, 0}), 64, 36};
};

TEST_F(ReferenceWhenStatic, StaticCameraConvergesToReference) {
  const double expected = mean_luminance(rig_, traced(ReferenceScope::full), 64, "static_full");
  protocol::Settings settings = traced(ReferenceScope::full);
  settings.reference.use = ReferenceUse::when_static;
  settings.reference.samples = 64;
  settings.accumulation.max_samples = 8;
  EXPECT_NEAR(mean_luminance(rig_, settings, 72, "static_hybrid"), expected, 0.01 * expected);
  EXPECT_FALSE(rig_.renderer.needs_frame());
  // More samples continue the accumulation.
  settings.reference.samples = 70;
  rig_.apply(settings);
  EXPECT_EQ(rig_.renderer.render().samples, 73u);
  settings.accumulation.max_samples = 100;
  rig_.apply(settings);
  EXPECT_EQ(rig_.renderer.render().samples, 74u);
  EXPECT_NEAR(mean_luminance(rig_, settings, 78, "static_more"), expected, 0.01 * expected);
}

TEST_F(ReferenceWhenStatic, TakesOverWithoutAVisibleJump) {
  rig_.apply(taken_over(12, 8));
  const render::Frame last = rig_.accumulate(12);
  const render::Frame first = rig_.renderer.render();
  ASSERT_EQ(first.samples, 13u);
  EXPECT_LE(difference(first, last).maximum, 1.0) << "what was shown stays";
  EXPECT_GT(ssim(rig_.accumulate(20), last), 0.97);
}

TEST_F(ReferenceWhenStatic, GetsMoreSimilarToTheReference) {
  rig_.apply(traced(ReferenceScope::full));
  const render::Frame truth = rig_.accumulate(256);
  rig_.apply(taken_over(24, 128));
  double before = ssim(rig_.accumulate(24), truth);
  const double hybrid = before;
  for (const std::uint32_t samples : {28u, 40u, 88u, 152u}) {
    const double now = ssim(rig_.accumulate(samples), truth);
    EXPECT_GT(now, before - 0.002) << samples;
    before = now;
  }
  EXPECT_GT(before, hybrid);
}

TEST_F(ReferenceWhenStatic, MovingTheCameraReturnsToTheHybrid) {
  rig_.apply(taken_over(4, 8));
  rig_.accumulate(12);
  rig_.renderer.set_camera(look({0.1f, 2, 6}, {0, 0.7f, 0}));
  rig_.renderer.render();
  for (const render::PassTime& pass : rig_.renderer.render().passes) {
    EXPECT_NE(pass.name, "reference.camera");
  }
}

TEST_F(ReferenceWhenStatic, IsAutomaticWithIndirectLight) {
  protocol::Settings settings;
  settings.accumulation.max_samples = 2;
  settings.reference.samples = 3;
  ASSERT_TRUE(rig_.renderer.set_settings(settings));
  rig_.accumulate(2);
  EXPECT_TRUE(rig_.renderer.needs_frame());
  rig_.accumulate(5);
  EXPECT_FALSE(rig_.renderer.needs_frame());
  settings.indirect.enabled = false;
  ASSERT_TRUE(rig_.renderer.set_settings(settings));
  rig_.accumulate(2);
  EXPECT_FALSE(rig_.renderer.needs_frame());
}

}  // namespace
}  // namespace heliograph::test
