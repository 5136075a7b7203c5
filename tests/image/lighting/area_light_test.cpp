#include <gtest/gtest.h>

#include <cmath>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::array roughnesses{0.05f, 0.2f, 0.4f, 0.7f, 1.0f};

/// Spheres from smooth to rough, metals in front of dielectrics, in a room corner.
void furnish_room(SceneBuilder& builder) {
  const auto wall = surface({0.7f, 0.68f, 0.65f}, 0.8f);
  builder.place(builder.add_quad({{{-8, 0, 6}, {8, 0, 6}, {8, 0, -4}, {-8, 0, -4}}}, wall));
  builder.place(builder.add_quad({{{-8, 0, -4}, {8, 0, -4}, {8, 6, -4}, {-8, 6, -4}}}, wall));
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 at(1.3f * static_cast<float>(i - 2), 0.5f, 0.0f);
    builder.place(builder.add_sphere(0.5f, surface({0.95f, 0.8f, 0.5f}, roughnesses[i], 1.0f)),
                  glm::translate(glm::mat4(1.0f), at + glm::vec3(0, 0, 1.4f)));
    builder.place(builder.add_sphere(0.5f, surface({0.2f, 0.35f, 0.6f}, roughnesses[i], 0.0f)),
                  glm::translate(glm::mat4(1.0f), at + glm::vec3(0.4f, 0, -0.4f)));
  }
}

/// Adds a rectangle and a disk light.
std::shared_ptr<scene::Scene> lit_scene(SceneBuilder& builder) {
  const auto scene = std::make_shared<scene::Scene>(*builder.build());
  shared::Light panel{};
  panel.type = shared::light_rectangle;
  panel.position = {-1.5f, 3.5f, 1.5f};
  panel.direction = glm::normalize(glm::vec3(0.3f, -1, -0.3f));
  panel.tangent = glm::normalize(glm::cross(panel.direction, glm::vec3(0, 0, 1)));
  panel.color = {6.0f, 5.5f, 5.0f};
  panel.half_width = 1.2f;
  panel.half_height = 0.5f;
  scene->lights.push_back({"panel", panel});
  shared::Light disk{};
  disk.type = shared::light_disk;
  disk.position = {3, 2.5f, 2};
  disk.direction = glm::normalize(glm::vec3(-1, -1, -0.6f));
  disk.tangent = glm::normalize(glm::cross(disk.direction, glm::vec3(0, 1, 0)));
  disk.color = {3, 4, 6};
  disk.radius = 0.6f;
  scene->lights.push_back({"disk", disk});
  return scene;
}

protocol::Settings plain_settings() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular.enabled = false;
  settings.ambient.occlusion = false;
  settings.antialiasing.temporal = false;
  settings.accumulation.blend_samples = 0;
  settings.accumulation.max_samples = 512;
  settings.reference.scope = protocol::ReferenceScope::full;
  settings.reference.bounces = 1;
  return settings;
}

render::FloatImage take(const std::string& name, const std::shared_ptr<scene::Scene>& scene,
                        const scene::Camera& camera, const protocol::Settings& settings,
                        VkExtent2D size, std::uint32_t samples) {
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), camera, size.width,
                  size.height);
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  return rig.capture("accumulated");
}

double mean_light(const render::FloatImage& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) sum += i % 4 == 3 ? 0.0 : image.rgba[i];
  return sum;
}

// The reference samples light areas and BRDF lobes; the hybrid uses linearly transformed cosines.
// A single sphere has no interreflections.
TEST(AreaLights, SphereMatchesAreaSampledGroundTruth) {
  for (const auto& [roughness, metallic] :
       {std::pair{0.2f, 1.0f}, {0.4f, 1.0f}, {0.7f, 1.0f}, {1.0f, 1.0f}, {0.4f, 0.0f}}) {
    SceneBuilder builder;
    builder.place(builder.add_sphere(0.8f, surface(glm::vec3(0.8f), roughness, metallic)));
    const auto scene = lit_scene(builder);
    const scene::Camera camera = look({0, 1, 5}, {0, 0, 0}, 22.0f);
    protocol::Settings settings = plain_settings();
    const auto hybrid = take("area_lit_sphere", scene, camera, settings, {48, 48}, 16);
    settings.reference.use = protocol::ReferenceUse::always;
    const auto reference =
        take("area_lit_sphere_ground_truth", scene, camera, settings, {48, 48}, 64);
    const double ratio = mean_light(hybrid) / mean_light(reference);
    std::printf("roughness %.2f, metallic %.0f: light %.4f of the reference\n", roughness, metallic,
                ratio);
    // One cosine lobe cannot fit a peak with long tails everywhere: 5 % measured.
    EXPECT_NEAR(ratio, 1.0, 0.06) << roughness << " " << metallic;
  }
}

// Saved for visual inspection: the reference also has diffuse interreflections.
TEST(AreaLights, CastSoftShadowsInRoom) {
  SceneBuilder builder;
  furnish_room(builder);
  const auto scene = lit_scene(builder);
  const scene::Camera camera = look({0, 2.6f, 6.5f}, {0, 0.7f, 0}, 38.0f);
  protocol::Settings settings = plain_settings();
  settings.specular.enabled = true;
  settings.exposure.compensation = 1.5f;
  const auto hybrid = take("area_lit_room", scene, camera, settings, {240, 120}, 24);
  settings.reference.use = protocol::ReferenceUse::always;
  const auto reference =
      take("area_lit_room_ground_truth", scene, camera, settings, {240, 120}, 16);
  for (const float value : hybrid.rgba) ASSERT_TRUE(std::isfinite(value));
  const double ratio = mean_light(hybrid) / mean_light(reference);
  EXPECT_LT(ratio, 1.0);
  EXPECT_GT(ratio, 0.6);
}

}  // namespace
}  // namespace heliograph::test
