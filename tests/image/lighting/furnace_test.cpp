#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/scenes/test_scenes.hpp"
#include "tests/image/support/renderer_rig.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

/// Expects radiance 1 within 2 % in every pixel: a white object in a white furnace is invisible.
void expect_white(RendererRig& rig, const std::string& name) {
  protocol::Settings settings;
  settings.indirect.enabled = settings.ambient.occlusion = false;  // spheres occlude each other
  settings.lighting.direct = false;
  settings.specular.enabled = false;  // traced reflections are noisy: SpecularRays tests them
  settings.tone_map.curve = protocol::ToneMapCurve::linear;
  settings.exposure.compensation = -1.0f;  // so that values above 1 are visible
  rig.apply(settings);
  save_image(name, rig.accumulate(4));
  const render::FloatImage radiance = rig.capture("accumulated");
  const render::FloatImage instance = rig.capture("gbuffer.instance");
  std::vector<float> largest(64, 0.0f), smallest(64, 2.0f);
  int covered = 0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    const auto id = static_cast<std::size_t>(instance.rgba[i]);
    covered += id > 0;
    for (int c = 0; c < 3; ++c) {
      largest[id] = std::max(largest[id], radiance.rgba[i + c]);
      smallest[id] = std::min(smallest[id], radiance.rgba[i + c]);
      ASSERT_TRUE(std::isfinite(radiance.rgba[i + c]));
    }
  }
  for (std::size_t id = 0; id < largest.size(); ++id) {
    if (largest[id] == 0.0f) continue;
    EXPECT_LE(largest[id], 1.02f) << name << ", instance " << id;
    EXPECT_GE(smallest[id], 0.98f) << name << ", instance " << id;
  }
  EXPECT_GT(covered * 20, static_cast<int>(radiance.rgba.size() / 4))
      << "too few pixels show spheres";
}

TEST(Furnace, WhiteSpheresOfAnyRoughnessVanish) {
  const auto scene =
      std::make_shared<const scene::Scene>(import_generated(scenes::make_furnace(), 16));
  RendererRig rig(scene, import_generated(scenes::make_white_environment()), scene->cameras.at(0),
                  320, 180);
  expect_white(rig, "furnace");
}

TEST(Furnace, WhiteDielectricsAndHalfMetalsVanish) {
  SceneBuilder builder;
  for (int i = 0; i < 10; ++i) {
    const float roughness = 0.25f * static_cast<float>(i % 5);
    const float metallic = i < 5 ? 0.0f : 0.5f;
    const glm::vec3 position(static_cast<float>(i % 5) - 2.0f, i < 5 ? 0.5f : -0.5f, 0);
    builder.place(builder.add_sphere(0.45f, surface(glm::vec3(1.0f), roughness, metallic)),
                  glm::translate(glm::mat4(1.0f), position));
  }
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 320, 180);
  expect_white(rig, "furnace_dielectric");
}

// A gray dielectric reflects its diffuse albedo plus the specular part.
TEST(Furnace, GrayDielectricReflectsItsAlbedo) {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(0.5f))));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(2.0f)),
                  look({0, 0, 4}, {0, 0, 0}, 36.0f), 64, 64);
  protocol::Settings settings;
  settings.ambient.occlusion = false;
  rig.apply(settings);
  rig.accumulate(1);
  const glm::vec3 middle = rgb(rig.capture("hdr"), 32, 32);
  EXPECT_NEAR(middle.x, 2.0f * 0.5f, 0.05f);
  EXPECT_EQ(middle.x, middle.y);
}

}  // namespace
}  // namespace heliograph::test
