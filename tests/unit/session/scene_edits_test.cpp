#include "session/state/scene_edits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using protocol::LightType;
using protocol::Vec3;

std::shared_ptr<const scene::Scene> a_scene() {
  auto scene = std::make_shared<scene::Scene>();
  scene::Light sun;
  sun.name = "sun";
  sun.device = {};
  sun.device.type = shared::light_directional;
  sun.device.direction = {0.0f, -1.0f, 0.0f};
  sun.device.tangent = {1.0f, 0.0f, 0.0f};
  sun.device.color = {4.0f, 2.0f, 1.0f};
  sun.device.radius = std::tan(glm::radians(1.0f));
  scene::Light panel = sun;
  panel.device.type = shared::light_rectangle;
  panel.device.half_width = 1.0f;
  panel.device.half_height = 0.5f;
  scene::Light nameless = sun;
  nameless.name.clear();
  nameless.device.type = shared::light_point;
  scene->lights = {sun, panel, nameless};
  shared::Material material{};
  material.base_color = {0.5f, 0.6f, 0.7f, 0.25f};
  material.roughness = 0.4f;
  material.base_color_texture.texture = 0;
  for (auto* slot : {&material.metallic_roughness_texture, &material.normal_texture,
                     &material.occlusion_texture, &material.emissive_texture}) {
    slot->texture = shared::no_texture;
  }
  scene->materials = {material, material};
  scene->material_names = {"paint", "paint"};
  return scene;
}

TEST(SceneEdits, MakesNamesOfLightsAndMaterialsUnique) {
  const SceneEdits edits(a_scene());
  EXPECT_EQ(edits.lights()[0].name, "sun");
  EXPECT_EQ(edits.lights()[1].name, "sun 2");
  EXPECT_EQ(edits.lights()[2].name, "light 3");
  EXPECT_EQ(edits.materials()[1].name, "paint 2");
}

TEST(SceneEdits, DescribesALightByTheParametersOfItsType) {
  const SceneEdits edits(a_scene());
  const protocol::LightInfo& sun = edits.lights()[0];
  EXPECT_EQ(sun.type, LightType::directional);
  EXPECT_FLOAT_EQ(sun.intensity, 4.0f);
  EXPECT_EQ(sun.color, (Vec3{1.0f, 0.5f, 0.25f}));
  EXPECT_NEAR(sun.angular_diameter.value(), 2.0f, 1e-4f);
  EXPECT_FALSE(sun.position || sun.radius || sun.width);
  const protocol::LightInfo& panel = edits.lights()[1];
  EXPECT_EQ(panel.width, 2.0f);
  EXPECT_EQ(panel.height, 1.0f);
  EXPECT_FALSE(panel.angular_diameter);
  EXPECT_EQ(edits.materials()[0].textures, std::vector<std::string>{"base_color"});
}

TEST(SceneEdits, CopiesNothingUntilAValueDiffers) {
  SceneEdits edits(a_scene());
  ASSERT_TRUE(edits.patch({.light = "sun", .patch = {}}));
  ASSERT_TRUE(edits.patch({.light = "sun", .patch = {.intensity = {4.0f}}}));
  EXPECT_FALSE(edits.device_lights());
  EXPECT_FALSE(edits.device_materials());
}

TEST(SceneEdits, APatchChangesOneLightAndKeepsTheOthersBitExact) {
  const auto scene = a_scene();
  SceneEdits edits(scene);
  ASSERT_TRUE(
      edits.patch({.light = "sun", .patch = {.intensity = {8.0f}, .angular_diameter = {10.0f}}}));
  const auto first = edits.device_lights();
  ASSERT_TRUE(first);
  EXPECT_EQ((*first)[0].color, glm::vec3(8.0f, 4.0f, 2.0f));
  EXPECT_NEAR((*first)[0].radius, std::tan(glm::radians(5.0f)), 1e-6f);
  EXPECT_EQ((*first)[1].color, scene->lights[1].device.color);
  ASSERT_TRUE(edits.patch({.light = "sun", .patch = {.enabled = {false}}}));
  EXPECT_EQ((*edits.device_lights())[0].color, glm::vec3(0.0f));
  EXPECT_EQ((*first)[0].color, glm::vec3(8.0f, 4.0f, 2.0f)) << "an older list was changed";
  EXPECT_FLOAT_EQ(edits.lights()[0].intensity, 8.0f) << "off is not dark";
}

TEST(SceneEdits, NullRestoresTheFilesValue) {
  SceneEdits edits(a_scene());
  ASSERT_TRUE(edits.patch({.light = "sun", .patch = {.color = {Vec3{1, 1, 1}}}}));
  protocol::LightPatch back;
  back.color.reset = true;
  const auto light = edits.patch({.light = "sun", .patch = back});
  ASSERT_TRUE(light);
  EXPECT_EQ(light->color, (Vec3{1.0f, 0.5f, 0.25f}));
}

TEST(SceneEdits, ListsMembersThatDifferFromTheFile) {
  SceneEdits edits(a_scene());
  EXPECT_TRUE(edits.lights()[0].changed.empty());
  ASSERT_TRUE(
      edits.patch({.light = "sun", .patch = {.enabled = {false}, .angular_diameter = {10.0f}}}));
  EXPECT_EQ(edits.lights()[0].changed, (std::vector<std::string>{"enabled", "angular_diameter"}));
  EXPECT_TRUE(edits.lights()[1].changed.empty());
  const auto half = edits.patch({.light = "sun", .patch = {.enabled = {true}}});
  EXPECT_EQ(half->changed, std::vector<std::string>{"angular_diameter"});
  ASSERT_TRUE(edits.patch({.material = "paint 2", .patch = {.roughness = {0.9f}}}));
  EXPECT_EQ(edits.materials()[1].changed, std::vector<std::string>{"roughness"});
  const auto back = edits.patch({.material = "paint 2", .patch = {.roughness = {0.4f}}});
  EXPECT_TRUE(back->changed.empty());
}

TEST(SceneEdits, RotatedAreaLightsKeepAnOrthogonalTangent) {
  SceneEdits edits(a_scene());
  for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, 0, 5}, Vec3{-1, 2, 3}}) {
    ASSERT_TRUE(edits.patch({.light = "sun 2", .patch = {.direction = {direction}}}));
    const shared::Light& panel = (*edits.device_lights())[1];
    EXPECT_NEAR(glm::length(panel.direction), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(panel.tangent), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(panel.direction, panel.tangent), 0.0f, 1e-5f);
  }
}

TEST(SceneEdits, RefusesParametersThatALightTypeLacks) {
  SceneEdits edits(a_scene());
  const auto refused =
      edits.patch({.light = "sun", .patch = {.intensity = {1.0f}, .position = {Vec3{0, 0, 0}}}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "patch.position");
  EXPECT_FLOAT_EQ(edits.lights()[0].intensity, 4.0f) << "half a patch was applied";
  EXPECT_EQ(edits.patch({.light = "sun 2", .patch = {.direction = {Vec3{0, 0, 0}}}}).error().path,
            "patch.direction");
  const auto unknown = edits.patch({.light = "sum", .patch = {}});
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_NE(unknown.error().message.find("sun"), std::string::npos);
}

TEST(SceneEdits, MaterialsKeepTheirAlphaAndTextures) {
  const auto scene = a_scene();
  SceneEdits edits(scene);
  const auto patched = edits.patch(
      {.material = "paint 2", .patch = {.base_color = {Vec3{1, 0, 0}}, .roughness = {0.9f}}});
  ASSERT_TRUE(patched);
  const auto& materials = *edits.device_materials();
  EXPECT_EQ(materials[1].base_color, glm::vec4(1.0f, 0.0f, 0.0f, 0.25f));
  EXPECT_EQ(materials[1].roughness, 0.9f);
  EXPECT_EQ(materials[1].base_color_texture.texture, 0u);
  EXPECT_EQ(materials[0].base_color, scene->materials[0].base_color);
}

}  // namespace
}  // namespace heliograph::session
