// Alpha-blended surfaces along rays: reflections, shadow rays and ambient rays pass with
// probability 1 - alpha.

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

protocol::Settings path_traced(protocol::ReferenceScope scope) {
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = scope;
  settings.reference.bounces = 2;
  return settings;
}

/// Mean over the center of the image, away from edges.
glm::vec3 center_mean(RendererRig& rig, const protocol::Settings& settings, std::uint32_t samples,
                      const char* name) {
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  const render::FloatImage radiance = rig.capture("accumulated");
  glm::vec3 sum(0.0f);
  int count = 0;
  for (std::uint32_t y = radiance.height / 4; y < 3 * radiance.height / 4; ++y) {
    for (std::uint32_t x = radiance.width / 4; x < 3 * radiance.width / 4; ++x, ++count) {
      sum += rgb(radiance, x, y);
    }
  }
  return sum / static_cast<float>(count);
}

/// A black pane of alpha 0.3.
shared::Material pane(bool unlit) {
  shared::Material material = surface(glm::vec3(0.0f), 1.0f);
  material.base_color = {0.0f, 0.0f, 0.0f, 0.3f};
  material.flags = shared::material_alpha_blend | shared::material_double_sided;
  if (unlit) material.flags |= shared::material_unlit;
  return material;
}

class BlendedRays : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << unsupported_reason(GetParam());
  }

  static void expect_all(RendererRig& rig, float expected, float tolerance,
                         const std::string& what) {
    using enum protocol::ReferenceScope;
    const std::vector<std::pair<const char*, protocol::Settings>> methods{
        {"hybrid", undenoised()},
        {"same_paths", path_traced(same_paths)},
        {"full", path_traced(full)}};
    for (const auto& [name, settings] : methods) {
      const std::string file = "blended_" + what + "_" + name;
      EXPECT_NEAR(center_mean(rig, settings, 128, file.c_str()).x, expected, tolerance * expected)
          << name;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Tracers, BlendedRays, testing::Values("embree", "software"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(BlendedRays, ReflectionsPassThroughByOneMinusAlpha) {
  SceneBuilder builder;
  shared::Material glow = surface(glm::vec3(0.0f), 1.0f, 1.0f);
  glow.emissive = glm::vec3(2.0f);
  glow.flags = shared::material_double_sided;
  // A mirror at 45 degrees reflects camera rays up through two panes to an emissive ceiling.
  builder.place(builder.add_quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}},
                                 surface(glm::vec3(1.0f), 0.0f, 1.0f)),
                glm::rotate(glm::mat4(1.0f), -0.7853982f, glm::vec3(1, 0, 0)));
  const auto level = [](float y) {
    return std::array<glm::vec3, 4>{{{-9, y, 9}, {9, y, 9}, {9, y, -9}, {-9, y, -9}}};
  };
  builder.place(builder.add_quad(level(3), pane(true)));
  builder.place(builder.add_quad(level(4), pane(true)));
  builder.place(builder.add_quad(level(6), glow));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 5}, {0, 0, 0}, 20.0f), 32, 32, GetParam());
  expect_all(rig, 2.0f * 0.7f * 0.7f, 0.03f, "mirror");
}

TEST_P(BlendedRays, ShadowsAreProportionalToAlpha) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface(glm::vec3(0.5f), 1.0f)));
  // Between the sun and the floor, outside the camera's view.
  builder.place(builder.add_quad({{{-3, 1, 3}, {3, 1, 3}, {3, 1, -3}, {-3, 1, -3}}}, pane(false)),
                glm::translate(glm::mat4(1.0f), {8.0f, 7.0f, 0}));
  builder.add_sun({-1, -1, 0}, glm::vec3(3.0f));
  scene::Camera camera = look({0, 5, 0}, {0, 0, 0});
  camera.up = {0, 0, -1};
  camera.orthographic_height = 2.0f;
  const auto scene = builder.build();
  RendererRig shaded(scene, scene::constant_environment(glm::vec3(0.0f)), camera, 32, 32,
                     GetParam());
  protocol::Settings open = undenoised();
  open.shadows.enabled = false;
  const float lit = center_mean(shaded, open, 4, "blended_open").x;
  EXPECT_GT(lit, 0.1f);
  expect_all(shaded, 0.7f * lit, 0.03f, "shadow");
}

TEST_P(BlendedRays, AmbientOcclusionIsProportionalToAlpha) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface(glm::vec3(0.5f), 1.0f)));
  // Above the camera.
  builder.place(
      builder.add_quad({{{-90, 3, 90}, {90, 3, 90}, {90, 3, -90}, {-90, 3, -90}}}, pane(false)));
  scene::Camera camera = look({0, 2, 0}, {0, 0, 0});
  camera.up = {0, 0, -1};
  camera.orthographic_height = 2.0f;
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)), camera, 32, 32,
                  GetParam());
  protocol::Settings settings = undenoised();
  settings.ambient.radius = 100.0f;
  settings.lighting.environment_specular = false;
  settings.ambient.occlusion = false;
  const float open = center_mean(rig, settings, 4, "blended_open_sky").x;
  EXPECT_GT(open, 0.1f);
  settings.ambient.occlusion = true;
  EXPECT_NEAR(center_mean(rig, settings, 48, "blended_sky").x, 0.7f * open, 0.02f * open);
}

/// A closed room of 4 m with a light behind a pane that it does not reach the front of.
std::shared_ptr<const scene::Scene> room_with_pane() {
  SceneBuilder builder;
  const std::array<std::array<glm::vec3, 4>, 6> walls{
      {{{{-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}}},
       {{{-2, 2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, 2, 2}}},
       {{{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}}},
       {{{2, -2, 2}, {-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}}},
       {{{-2, -2, 2}, {-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}}},
       {{{2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}}}}};
  builder.place(builder.add_quads(walls, surface({0.7f, 0.5f, 0.3f})));
  shared::Material front = surface(glm::vec3(0.8f));
  front.base_color.w = 0.8f;
  front.flags = shared::material_alpha_blend;
  builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, front));
  builder.add_point_light({0, 1.4f, -1}, glm::vec3(2.0f));
  return builder.build();
}

TEST(BlendedLight, GathersIndirectLightAsTheReferenceDoes) {
  RendererRig rig(room_with_pane(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 1.9f}, {0, 0, 0}, 40.0f), 48, 48);
  protocol::Settings reference = path_traced(protocol::ReferenceScope::full);
  reference.reference.bounces = 16;
  const glm::vec3 truth = center_mean(rig, reference, 256, "blended_indirect_reference");
  protocol::Settings settings;
  settings.accumulation.max_samples = 4096;
  settings.antialiasing.temporal = false;
  const glm::vec3 got = center_mean(rig, settings, 160, "blended_indirect");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], truth[c], 0.06f * truth[c]) << c;
}

/// Reflections of a rough blended pane over frames of a moving view.
struct MovingReflections {
  double mean = 0.0;
  double traced = 0.0;  // fraction of pixels
};

MovingReflections moving_reflections(bool planned) {
  SceneBuilder builder;
  shared::Material rough = surface(glm::vec3(0.5f), 0.5f);
  rough.base_color.w = 0.6f;
  rough.flags = shared::material_alpha_blend | shared::material_double_sided;
  builder.place(builder.add_quad({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}}, rough));
  const glm::vec3 target(0.0f);
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 5}, target, 20.0f), 48, 48);
  protocol::Settings settings;
  settings.sampling.specular = planned;
  rig.apply(settings);
  MovingReflections sum;
  constexpr int frames = 24, first = 4;
  for (int frame = 0; frame < frames; ++frame) {
    rig.renderer.set_camera(look({0.02f * static_cast<float>(frame), 0, 5}, target, 20.0f));
    rig.renderer.render();
    if (frame < first) continue;
    const render::FloatImage image = rig.capture("blended.specular");
    const double share = 4.0 / static_cast<double>(image.rgba.size()) / (frames - first);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      sum.mean += share * image.rgba[i];
      sum.traced += share * (image.rgba[i] > 0.0f);
    }
  }
  return sum;
}

// Rough surfaces reflect a quarter of their rays while the view moves, each with four times the
// light (shared::plan_quiet_factor).
TEST(BlendedReflections, TraceFewerRaysInMotionWithTheSameMean) {
  const MovingReflections all = moving_reflections(false), fewer = moving_reflections(true);
  EXPECT_GT(all.mean, 0.005);
  EXPECT_NEAR(fewer.mean, all.mean, 0.04 * all.mean);
  EXPECT_GT(all.traced, 0.9);  // a few go below the surface
  EXPECT_NEAR(fewer.traced, 0.25 * all.traced, 0.03);
}

}  // namespace
}  // namespace heliograph::test
