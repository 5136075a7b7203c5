// KHR_materials_diffuse_transmission: leaves, lampshades, paper. Light from behind thin walls,
// by the hybrid and by the path tracer.
#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "scene/gltf/materials/layer_table.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

MaterialLayers diffusing(float fraction, const glm::vec3& tint = glm::vec3(1.0f)) {
  return {.diffuse_transmission = fraction, .diffuse_transmission_color = tint};
}

/// Without any reflection: all light enters.
MaterialLayers paper(float fraction, const glm::vec3& tint = glm::vec3(1.0f)) {
  MaterialLayers layers = diffusing(fraction, tint);
  layers.specular = 0.0f;
  return layers;
}

enum class Technique { rays, raster, same_paths, full };

protocol::Settings technique_settings(Technique way) {
  protocol::Settings settings = undenoised();
  if (way == Technique::raster) settings.gbuffer.source = protocol::PrimaryVisibility::raster;
  if (way == Technique::rays) settings.gbuffer.source = protocol::PrimaryVisibility::rays;
  if (way == Technique::rays || way == Technique::raster) return settings;
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = way == Technique::full ? protocol::ReferenceScope::full
                                                    : protocol::ReferenceScope::same_paths;
  settings.reference.bounces = 16;
  return settings;
}

std::string technique_name(const testing::TestParamInfo<Technique>& info) {
  const std::string names[] = {"rays", "raster", "same_paths", "full"};
  return names[static_cast<int>(info.param)];
}

class DiffuseTransmission : public testing::TestWithParam<Technique> {
 protected:
  const protocol::Settings settings_ = technique_settings(GetParam());
  const std::string name_ = technique_name({GetParam(), 0});  // of images
};
INSTANTIATE_TEST_SUITE_P(Ways, DiffuseTransmission,
                         testing::Values(Technique::rays, Technique::raster, Technique::same_paths,
                                         Technique::full),
                         technique_name);

/// Two metres wide, in the plane z = 0, facing +z.
const std::array<glm::vec3, 4> thin_pane{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};

RendererRig rig_before(SceneBuilder& builder, const scene::Environment& environment) {
  return {builder.build(), environment, look({0, 0, 3}, {0, 0, 0}, 20.0f), 24, 24};
}

scene::Environment no_sky() {
  return scene::constant_environment(glm::vec3(0.0f));
}

/// White panes and spheres of many kinds, four in a row.
SceneBuilder white_translucents() {
  SceneBuilder builder;
  MaterialLayers coated = diffusing(0.5f);
  coated.clearcoat = 1.0f;
  coated.clearcoat_roughness = 0.3f;
  MaterialLayers velvet = diffusing(0.75f);
  velvet.sheen_color = glm::vec3(0.8f);
  velvet.sheen_roughness = 0.5f;
  MaterialLayers glassy = diffusing(0.5f);
  glassy.specular = 0.5f;
  const MaterialLayers kinds[] = {diffusing(0.25f), diffusing(0.5f), diffusing(1.0f), coated,
                                  velvet,           glassy,          paper(0.5f),     coated};
  for (int i = 0; i < 8; ++i) {
    const float metallic = i == 7 ? 0.5f : 0.0f;
    const auto white = surface(glm::vec3(1.0f), 0.2f + 0.1f * static_cast<float>(i), metallic);
    const auto material = builder.with_layers(white, kinds[i]);
    const auto mesh =
        i % 2 ? builder.add_sphere(0.45f, material) : builder.add_quad(thin_pane, material);
    const glm::mat4 at = glm::translate(
        glm::mat4(1.0f), {static_cast<float>(i % 4) - 1.5f, i < 4 ? 0.5f : -0.5f, 0.0f});
    builder.place(mesh, i % 2 ? at : glm::scale(at, glm::vec3(0.4f)));
  }
  return builder;
}

// What is not reflected passes: thin white walls vanish in white light from everywhere.
TEST_P(DiffuseTransmission, WhiteWallsVanishInAFurnace) {
  if (GetParam() == Technique::full) GTEST_SKIP() << "noisy: the mean of it is tested below";
  RendererRig rig(white_translucents().build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 128, 72);
  protocol::Settings settings = settings_;
  settings.ambient.occlusion = settings.specular.enabled = settings.lighting.direct = false;
  rig.apply(settings);
  save_image("furnace_translucent_" + name_, rig.accumulate(4));
  const render::FloatImage radiance = rig.capture("accumulated");
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    if (i % 4 == 3) continue;  // the mean's variance
    ASSERT_NEAR(radiance.rgba[i], 1.0f, 0.02f) << "pixel " << i / 4;
  }
}

TEST(DiffuseTransmissionFurnace, PathsLoseNoLight) {
  RendererRig rig(white_translucents().build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 22.0f), 96, 54);
  const glm::dvec3 mean =
      mean_color(rig, technique_settings(Technique::full), "furnace_translucent_full", 128);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0, 0.01) << "channel " << c;
}

// Indirect light is gathered on both sides.
TEST(DiffuseTransmissionFurnace, GatheredLightIsThatOfBothSides) {
  for (const Technique way : {Technique::rays, Technique::raster}) {
    SceneBuilder builder;
    builder.place(
        builder.add_quad(thin_pane, builder.with_layers(surface(glm::vec3(1.0f)), paper(0.5f))));
    RendererRig rig = rig_before(builder, scene::constant_environment(glm::vec3(1.0f)));
    protocol::Settings settings = technique_settings(way);
    settings.indirect.enabled = true;
    settings.specular.enabled = false;
    const glm::dvec3 mean = mean_color(rig, settings, "furnace_translucent_gathered", 64);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0, 0.015) << "channel " << c;
  }
}

const glm::vec3 leaf_green(0.2f, 0.8f, 0.1f);
const glm::vec3 deep_amber(0.9f, 0.5f, 0.15f);

/// A wall of green paper, amber in transmitted light, lit by a sun that shines along `direction`.
SceneBuilder sunlit(float fraction, const glm::vec3& direction) {
  SceneBuilder builder;
  builder.place(builder.add_quad(
      thin_pane, builder.with_layers(surface(leaf_green), paper(fraction, deep_amber))));
  builder.add_sun(direction, glm::vec3(3.0f, 2.5f, 2.0f));
  return builder;
}

TEST_P(DiffuseTransmission, ASunBehindShinesThroughTheWall) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.4f, -0.5f, 1.0f));
  SceneBuilder builder = sunlit(0.6f, direction);
  RendererRig rig = rig_before(builder, no_sky());
  const glm::dvec3 seen = mean_color(rig, settings_, "translucent_sun_behind_" + name_, 8);
  const glm::vec3 irradiance = glm::vec3(3.0f, 2.5f, 2.0f) * direction.z;
  for (int c = 0; c < 3; ++c) {
    const float expected = 0.6f * deep_amber[c] * irradiance[c] / glm::pi<float>();
    EXPECT_NEAR(seen[c] / expected, 1.0, 0.02) << "channel " << c;
  }
}

TEST_P(DiffuseTransmission, ASunInFrontGetsTheRestBack) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.4f, -0.5f, -1.0f));
  SceneBuilder builder = sunlit(0.6f, direction);
  RendererRig rig = rig_before(builder, no_sky());
  const glm::dvec3 seen = mean_color(rig, settings_, "translucent_sun_in_front_" + name_, 8);
  const glm::vec3 irradiance = glm::vec3(3.0f, 2.5f, 2.0f) * -direction.z;
  for (int c = 0; c < 3; ++c) {
    const float expected = 0.4f * leaf_green[c] * irradiance[c] / glm::pi<float>();
    EXPECT_NEAR(seen[c] / expected, 1.0, 0.02) << "channel " << c;
  }
}

// Shadow rays leave on the side of the light.
TEST_P(DiffuseTransmission, WhatIsBehindThrowsItsShadowOnTheWall) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.4f, -0.5f, 1.0f));
  const auto mean = [&](float z) {
    SceneBuilder builder = sunlit(0.6f, direction);
    builder.place(builder.add_quad(thin_pane, surface(glm::vec3(0.0f))),
                  glm::scale(glm::translate(glm::mat4(1.0f), {0, 0, z}), glm::vec3(6.0f)));
    scene::Camera camera = look({0, 0, 0.5f}, {0, 0, 0}, 20.0f);
    RendererRig rig(builder.build(), no_sky(), camera, 16, 16);
    return mean_color(rig, settings_, "translucent_shadow_" + name_, 8).y;
  };
  EXPECT_GT(mean(1.0f), 0.1) << "behind the camera";
  EXPECT_LT(mean(-0.5f), 1e-3) << "between wall and sun";
}

// Half of the environment is white, that behind the wall: light from there has the tint alone.
TEST_P(DiffuseTransmission, TheEnvironmentBehindHasTheTint) {
  SceneBuilder builder;
  builder.place(builder.add_quad(
      thin_pane, builder.with_layers(surface(leaf_green), paper(0.7f, deep_amber))));
  const scene::Environment half =
      make_environment(256, [](const glm::vec3& d) { return glm::vec3(d.z < 0.0f ? 1.0f : 0.0f); });
  RendererRig rig = rig_before(builder, half);
  std::vector<protocol::Settings> all{settings_};
  if (GetParam() == Technique::rays || GetParam() == Technique::raster) {
    all.push_back(settings_);
    all.back().indirect.enabled = true;
  }
  for (const protocol::Settings& settings : all) {
    const glm::dvec3 seen = mean_color(rig, settings, "translucent_environment_" + name_, 192);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(seen[c], 0.7f * deep_amber[c], 0.02)
          << "channel " << c << ", indirect " << settings.indirect.enabled;
    }
  }
}

shared::Light panel_behind() {
  shared::Light light{};
  light.type = shared::light_rectangle;
  light.position = {0.3f, 0.2f, -1.5f};
  light.direction = {0, 0, 1};
  light.tangent = {1, 0, 0};
  light.color = {5.0f, 4.0f, 3.0f};
  light.half_width = 0.6f;
  light.half_height = 0.4f;
  return light;
}

/// Leaves with all textures, and a lampshade around a light, before a panel.
std::shared_ptr<const scene::Scene> garden() {
  SceneBuilder builder;
  MaterialLayers leaf = diffusing(0.8f, {0.5f, 0.9f, 0.2f});
  leaf.diffuse_transmission_texture.texture =
      builder.add_texture(2, 2, false, {0, 0, 0, 255, 0, 0, 0, 90, 0, 0, 0, 190, 0, 0, 0, 255});
  leaf.diffuse_transmission_color_texture.texture = builder.add_texture(
      2, 2, true, {255, 255, 255, 255, 90, 255, 90, 255, 255, 90, 90, 255, 200, 200, 255, 255});
  shared::Material green_leaf = surface({0.15f, 0.5f, 0.1f}, 0.5f);
  green_leaf.flags = shared::material_double_sided;
  const auto leaf_mesh = builder.add_quad(thin_pane, builder.with_layers(green_leaf, leaf));
  for (int i = 0; i < 3; ++i) {
    glm::mat4 at = glm::translate(glm::mat4(1.0f), {1.1f * static_cast<float>(i) - 2.0f, 1.0f, 0});
    at = glm::rotate(at, 0.8f * static_cast<float>(i - 1), glm::vec3(0.3f, 1, 0.1f));
    builder.place(leaf_mesh, glm::scale(at, glm::vec3(0.5f)));
  }
  MaterialLayers shade = diffusing(0.6f, {0.9f, 0.7f, 0.4f});
  shade.sheen_color = glm::vec3(0.3f);
  shade.sheen_roughness = 0.6f;
  shared::Material linen = surface({0.8f, 0.8f, 0.7f}, 0.8f);
  linen.flags = shared::material_double_sided;
  builder.place(builder.add_sphere(0.5f, builder.with_layers(linen, shade)),
                glm::translate(glm::mat4(1.0f), {2.0f, 0.8f, 0.3f}));
  builder.place(builder.add_quad({{{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}}},
                                 surface({0.5f, 0.4f, 0.3f}, 0.4f)));
  builder.add_sun({0.3f, -0.7f, 0.8f}, {2.5f, 2.3f, 2.0f}, 1.0f);
  builder.add_point_light({2.0f, 0.8f, 0.3f}, {0.6f, 0.5f, 0.4f}, 0.02f);
  auto made = std::make_shared<scene::Scene>(*builder.build());
  made->lights.push_back({"panel", panel_behind(), 0.0f});
  return made;
}

glm::vec3 garden_sky(const glm::vec3& d) {
  return glm::vec3(0.3f, 0.35f, 0.5f) + glm::vec3(0.2f, 0.2f, 0.1f) * d.y + 0.1f * d.z;
}

RendererRig garden_rig() {
  return {garden(), make_environment(128, garden_sky), look({0.2f, 1.6f, 5}, {0, 0.7f, 0}, 40.0f),
          96, 54};
}

TEST_P(DiffuseTransmission, HybridConvergesToPathTracerAlongSamePaths) {
  if (GetParam() == Technique::same_paths || GetParam() == Technique::full)
    GTEST_SKIP() << "is the reference";
  RendererRig rig = garden_rig();
  const glm::dvec3 got = mean_color(rig, settings_, "translucent_garden_" + name_);
  const glm::dvec3 expected =
      mean_color(rig, technique_settings(Technique::same_paths), "translucent_garden_reference");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.015) << "channel " << c;
}

// All light, what is scattered more than once included.
TEST(DiffuseTransmissionIndirect, HybridLooksAsInReference) {
  RendererRig rig = garden_rig();
  protocol::Settings settings = undenoised();
  settings.indirect.enabled = true;
  mean_color(rig, settings, "translucent_garden_first", 64);  // the cache learns
  rig.renderer.set_camera(look({0.2f, 1.6f, 4.99f}, {0, 0.7f, 0}, 40.0f));
  const glm::dvec3 got = mean_color(rig, settings, "translucent_garden_gathered", 128);
  const glm::dvec3 expected =
      mean_color(rig, technique_settings(Technique::full), "translucent_garden_full", 256);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.06) << "channel " << c;
}

// Area lights by linearly transformed cosines, or by points of them.
TEST_P(DiffuseTransmission, APanelBehindShinesThroughTheWall) {
  const auto wall = [](bool behind) {
    SceneBuilder builder;
    // What reaches the front of a white wall reaches the front of one that passes all.
    const auto layers = behind ? paper(1.0f, deep_amber) : MaterialLayers{.specular = 0.0f};
    builder.place(builder.add_quad(
        thin_pane, builder.with_layers(surface(behind ? leaf_green : deep_amber, 1.0f), layers)));
    auto made = std::make_shared<scene::Scene>(*builder.build());
    shared::Light panel = panel_behind();
    if (!behind) {
      panel.position.z = -panel.position.z;
      panel.direction = -panel.direction;
    }
    made->lights.push_back({"panel", panel, 0.0f});
    return made;
  };
  // The eye is nearer than the panel in front: it lies behind the eye.
  const scene::Camera camera = look({0, 0, 1.2f}, {0, 0, 0}, 50.0f);
  RendererRig in_front(wall(false), no_sky(), camera, 24, 24);
  RendererRig behind(wall(true), no_sky(), camera, 24, 24);
  const glm::dvec3 expected = mean_color(in_front, settings_, "panel_in_front_" + name_, 64);
  const glm::dvec3 seen = mean_color(behind, settings_, "panel_behind_" + name_, 64);
  EXPECT_GT(expected.x, 0.05);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.02) << "channel " << c;
}

/// 300 lights behind a wall, more than are summed one by one.
TEST_P(DiffuseTransmission, LightsOfTheGridShineThroughTheWall) {
  if (GetParam() == Technique::same_paths) GTEST_SKIP() << "sums all lights";
  SceneBuilder builder;
  builder.place(builder.add_quad(
      thin_pane, builder.with_layers(surface(leaf_green), paper(0.6f, deep_amber))));
  for (int i = 0; i < 300; ++i) {
    builder.add_point_light({0.15f * static_cast<float>(i % 20) - 1.5f,
                             0.2f * static_cast<float>(i / 20) - 1.5f, -0.8f},
                            glm::vec3(0.02f));
  }
  RendererRig rig = rig_before(builder, no_sky());
  protocol::Settings all = technique_settings(Technique::same_paths);
  const glm::dvec3 expected = mean_color(rig, all, "translucent_lights_all", 8);
  const glm::dvec3 seen = mean_color(rig, settings_, "translucent_lights_" + name_, 128);
  EXPECT_GT(expected.x, 0.05);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.03) << "channel " << c;
}

// A triangle that emits light, behind a wall, by gathering rays and by rays to its points.
TEST(DiffuseTransmissionIndirect, EmissiveSurfacesShineThroughTheWall) {
  SceneBuilder builder;
  builder.place(builder.add_quad(
      thin_pane, builder.with_layers(surface(leaf_green), paper(0.6f, deep_amber))));
  shared::Material emitter = surface(glm::vec3(0.0f));
  emitter.emissive = {4.0f, 3.0f, 2.0f};
  builder.place(builder.add_quad(thin_pane, emitter),
                glm::scale(glm::translate(glm::mat4(1.0f), {0.2f, 0.1f, -1.0f}), glm::vec3(0.3f)));
  RendererRig rig = rig_before(builder, no_sky());
  const glm::dvec3 expected =
      mean_color(rig, technique_settings(Technique::full), "translucent_emissive_full", 512);
  protocol::Settings settings = undenoised();
  settings.indirect.enabled = true;
  const glm::dvec3 seen = mean_color(rig, settings, "translucent_emissive", 256);
  EXPECT_GT(expected.x, 0.02);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.04) << "channel " << c;
}

// KHR_materials_transmission takes precedence, and metals let nothing through.
TEST_P(DiffuseTransmission, OnlyTheDiffuseLightPasses) {
  const glm::vec3 direction(0, 0, 1);
  const auto seen = [&](const shared::Material& base, const MaterialLayers& layers) {
    SceneBuilder builder;
    builder.place(builder.add_quad(thin_pane, builder.with_layers(base, layers)));
    builder.add_sun(direction, glm::vec3(glm::pi<float>()));
    RendererRig rig = rig_before(builder, no_sky());
    return mean_color(rig, settings_, "translucent_precedence_" + name_, 64).y;
  };
  EXPECT_NEAR(seen(surface(leaf_green), paper(1.0f)), 1.0, 0.02);
  EXPECT_LT(seen(surface(leaf_green, 1.0f, 1.0f), paper(1.0f)), 1e-3);
  MaterialLayers clear = paper(1.0f);
  clear.transmission = 0.75f;
  EXPECT_NEAR(seen(surface(leaf_green), clear), 0.25, 0.02);
  MaterialLayers thick = paper(1.0f);
  thick.thickness = 0.5f;
  thick.attenuation_distance = 1.0f;
  thick.attenuation_color = glm::vec3(0.25f);
  EXPECT_NEAR(seen(surface(leaf_green), thick), 0.5, 0.02) << "what the volume leaves";
}

// A material whose file has no extension gets it by an edit and loses it again.
TEST_P(DiffuseTransmission, EditsLetLightThrough) {
  SceneBuilder builder;
  builder.place(builder.add_quad(thin_pane, builder.with_layers(surface(leaf_green), {})));
  builder.add_sun({0, 0, 1}, glm::vec3(glm::pi<float>()));
  const auto scene = builder.build();
  RendererRig rig(scene, no_sky(), look({0, 0, 3}, {0, 0, 0}, 20.0f), 16, 16);
  EXPECT_LT(mean_color(rig, settings_, "translucent_before_edit", 8).x, 1e-3);
  std::vector<shared::Material> materials = scene->materials;
  std::vector<shared::MaterialLayer> layers = scene->layers;
  materials[0].layer = static_cast<std::uint32_t>(layers.size());
  layers.push_back(scene::layer_of(materials[0], paper(0.5f, deep_amber)));
  rig.renderer.set_materials(materials, layers);
  const glm::dvec3 edited = mean_color(rig, settings_, "translucent_edited", 8);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(edited[c], 0.5f * deep_amber[c], 0.02f * deep_amber[c] + 0.002f);
  rig.renderer.set_materials(scene->materials);
  EXPECT_LT(mean_color(rig, settings_, "translucent_after_edit", 8).x, 1e-3);
}

}  // namespace
}  // namespace heliograph::test
