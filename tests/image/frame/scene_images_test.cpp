#include <gtest/gtest.h>

#include <cmath>

#include "scene/import.hpp"
#include "scenes/generator/atrium/atrium.hpp"
#include "tests/image/support/renderer_rig.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

void expect_sane(const render::FloatImage& radiance) {
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    ASSERT_TRUE(std::isfinite(radiance.rgba[i])) << i / 4;
    ASSERT_GE(radiance.rgba[i], 0.0f) << i / 4;
  }
}

double covered_share(const render::FloatImage& instance) {
  double count = 0.0;
  for (std::size_t i = 0; i < instance.rgba.size(); i += 4) count += instance.rgba[i] > 0.0f;
  return count / static_cast<double>(instance.rgba.size() / 4);
}

TEST(Atrium, IsLitBySunAndSky) {
  const auto sky = scenes::make_clear_sky(
      scenes::direction_to_sun(scenes::sun_elevation, scenes::sun_azimuth), 512, 256);
  const auto scene =
      std::make_shared<const scene::Scene>(import_generated(scenes::make_atrium(1, sky), 128));
  EXPECT_GT(scene->triangle_count(), 200'000u);
  ASSERT_FALSE(scene->cameras.empty());
  RendererRig rig(scene, import_generated(sky.environment), scene->cameras[0], 320, 180);
  const render::Frame frame = rig.accumulate(16);
  save_image("atrium", frame);
  const render::FloatImage radiance = rig.capture("accumulated");
  const render::FloatImage visibility = rig.capture("shadows.visibility");
  const render::FloatImage instance = rig.capture("gbuffer.instance");
  expect_sane(radiance);
  EXPECT_GT(covered_share(instance), 0.5);
  double code_values = 0.0;
  for (std::size_t i = 0; i < frame.rgba.size(); i += 4) code_values += frame.rgba[i + 1];
  code_values /= static_cast<double>(frame.rgba.size() / 4);
  EXPECT_GT(code_values, 40.0) << "too dark";
  EXPECT_LT(code_values, 215.0) << "too bright";
  double lit = 0.0, shadowed = 0.0;
  int lit_count = 0, shadowed_count = 0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    if (instance.rgba[i] == 0.0f) continue;
    (visibility.rgba[i] > 0.5f ? lit : shadowed) += radiance.rgba[i + 1];
    ++(visibility.rgba[i] > 0.5f ? lit_count : shadowed_count);
  }
  EXPECT_GT(lit_count, 500);
  EXPECT_GT(shadowed_count, 5000);
  EXPECT_GT(lit / lit_count, 2.0 * shadowed / shadowed_count) << "sunlit areas must be brighter";
}

struct Model {
  const char* name;
  const char* file;
  glm::vec3 eye_direction;  // from the center of the scene
  double least_cover, most_cover;
};

class Models : public testing::TestWithParam<Model> {};

TEST_P(Models, RadianceAndCoverageAreInRange) {
  const auto file = asset(std::filesystem::path("gltf") / GetParam().file);
  const auto sky = asset("hdr/venice.hdr");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  const glm::vec3 center = scene->bounds.center();
  const scene::Camera camera =
      look(center + 2.6f * scene->bounds.radius() * glm::normalize(GetParam().eye_direction),
           center, 40.0f);
  RendererRig rig(scene, scene::load_environment(*sky), camera, 640, 480);
  save_image(GetParam().name, rig.accumulate(16));
  for (const char* buffer :
       {"gbuffer.normals", "gbuffer.base_color", "gbuffer.surface", "gbuffer.emissive"}) {
    save_image(std::string(GetParam().name) + "_" + (buffer + 8),
               *rig.renderer.capture_view(buffer));
  }
  expect_sane(rig.capture("accumulated"));
  const double cover = covered_share(rig.capture("gbuffer.instance"));
  EXPECT_GT(cover, GetParam().least_cover);
  EXPECT_LT(cover, GetParam().most_cover);
  const double brightness = mean_luminance(rig.capture("accumulated"));
  EXPECT_GT(brightness, 0.02);
  EXPECT_LT(brightness, 20.0);
}

std::string model_name(const testing::TestParamInfo<Model>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Known, Models,
    testing::Values(
        Model{"damaged_helmet", "DamagedHelmet.glb", {0.3f, 0.2f, 1}, 0.15, 0.7},
        Model{"flight_helmet", "FlightHelmet/FlightHelmet.gltf", {0.3f, 0.2f, 1}, 0.1, 0.6},
        Model{"normal_tangent_test", "NormalTangentTest.glb", {0, 0, 1}, 0.1, 0.95}),
    model_name);

TEST(DamagedHelmet, EmissiveTextureIsVisible) {
  const auto file = asset("gltf/DamagedHelmet.glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  const scene::Camera camera =
      look(scene->bounds.center() + glm::vec3(0.5f, 0.3f, 3.2f), scene->bounds.center(), 45.0f);
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), camera, 320, 240);
  save_image("damaged_helmet_emissive_only", rig.accumulate(2));
  const render::FloatImage radiance = rig.capture("accumulated");
  int glowing = 0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    glowing += radiance.rgba[i + 2] > 0.1f || radiance.rgba[i] > 0.1f;
  }
  EXPECT_GT(glowing, 50);
  EXPECT_LT(glowing, 320 * 240 / 4);
}

}  // namespace
}  // namespace heliograph::test
