#include "session/edits/scene_edits.hpp"

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
  const protocol::LightInfo sun = edits.lights()[0];
  EXPECT_EQ(sun.type, LightType::directional);
  EXPECT_FLOAT_EQ(sun.intensity, 4.0f);
  EXPECT_EQ(sun.color, (Vec3{1.0f, 0.5f, 0.25f}));
  EXPECT_NEAR(sun.angular_diameter.value(), 2.0f, 1e-4f);
  EXPECT_FALSE(sun.position || sun.radius || sun.width);
  const protocol::LightInfo panel = edits.lights()[1];
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

TEST(SceneEdits, ATemperatureGivesTheColorAndAColorEndsIt) {
  SceneEdits edits(a_scene());
  const auto warm = edits.patch({.light = "sun", .patch = {.temperature = {3000.0f}}});
  ASSERT_TRUE(warm);
  // Linear sRGB of a black body at 3000 K: 1, 0.462, 0.154 (from CIE 1931 chromaticity .4369,
  // .4041).
  EXPECT_NEAR(warm->color[0], 1.0f, 1e-3f);
  EXPECT_NEAR(warm->color[1], 0.462f, 0.02f);
  EXPECT_NEAR(warm->color[2], 0.154f, 0.02f);
  const auto white = edits.patch({.light = "sun", .patch = {.temperature = {6504.0f}}});
  for (const float component : white->color) EXPECT_NEAR(component, 1.0f, 0.06f);
  const auto green = edits.patch({.light = "sun", .patch = {.color = {Vec3{0, 1, 0}}}});
  EXPECT_FALSE(green->temperature);
  ASSERT_TRUE(edits.patch({.light = "sun", .patch = {.temperature = {3000.0f}}}));
  const auto file = edits.patch({.light = "sun", .patch = {.temperature = {{}, true}}});
  EXPECT_EQ(file->color, (Vec3{1.0f, 0.5f, 0.25f}));
  EXPECT_TRUE(file->changed.empty());
}

TEST(SceneEdits, AddedLightsFollowThoseOfTheFile) {
  SceneEdits edits(a_scene());
  const auto added = edits.add({.type = LightType::disk,
                                .name = "panel",
                                .patch = protocol::LightPatch{.position = {Vec3{1, 2, 3}}}});
  ASSERT_TRUE(added);
  EXPECT_TRUE(added->added);
  ASSERT_EQ(edits.device_lights()->size(), 4u);
  EXPECT_EQ(edits.device_lights()->back().position, glm::vec3(1, 2, 3));
  EXPECT_EQ(edits.add({.type = LightType::point, .name = "sun"}).error().path, "name");
  EXPECT_EQ(edits.add({.type = LightType::point})->name, "point light");
  EXPECT_EQ(edits.add({.type = LightType::point})->name, "point light 2");
  ASSERT_TRUE(edits.remove_light("panel"));
  EXPECT_EQ(edits.device_lights()->size(), 5u);
  EXPECT_EQ(edits.remove_light("panel").error().code, ErrorCode::not_found);
}

TEST(SceneEdits, ARemovedLightOfTheFileKeepsItsPlaceAndComesBack) {
  SceneEdits edits(a_scene());
  ASSERT_TRUE(edits.remove_light("sun"));
  EXPECT_EQ(edits.lights().size(), 2u);
  ASSERT_EQ(edits.device_lights()->size(), 3u);
  EXPECT_EQ(edits.device_lights()->front().color, glm::vec3(0.0f));
  EXPECT_FALSE(edits.patch({.light = "sun", .patch = {.intensity = {2.0f}}}));
  EXPECT_EQ(edits.add({.type = LightType::point, .name = "sun"}).error().path, "type");
  const auto back = edits.add({.type = LightType::directional,
                               .name = "sun",
                               .patch = protocol::LightPatch{.intensity = {2.0f}}});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->changed, std::vector<std::string>{"intensity"});
  EXPECT_EQ(edits.device_lights()->front().color, glm::vec3(2.0f, 1.0f, 0.5f));
}

TEST(SceneEdits, ADocumentLeadsToTheSameTablesInAnotherSession) {
  SceneEdits edits(a_scene());
  ASSERT_TRUE(edits.patch({.light = "sun 2", .patch = {.temperature = {2700.0f}}}));
  ASSERT_TRUE(edits.remove_light("sun"));
  ASSERT_TRUE(edits.add({.type = LightType::spot, .name = "key"}));
  ASSERT_TRUE(
      edits.patch({.light = "key", .patch = {.inner_cone = {10.0f}, .outer_cone = {20.0f}}}));
  ASSERT_TRUE(edits.patch({.material = "paint", .patch = {.metallic = {1.0f}}}));
  protocol::EditDocument document;
  edits.describe(document);
  SceneEdits others(a_scene());
  ASSERT_TRUE(others.apply(document));
  protocol::EditDocument again;
  others.describe(again);
  EXPECT_EQ(document, again);
  const auto expect_near = [](const glm::vec3& a, const glm::vec3& b) {
    EXPECT_NEAR(glm::distance(a, b), 0.0f, 1e-4f);
  };
  for (std::size_t i = 0; i < edits.device_lights()->size(); ++i) {
    const shared::Light &one = (*edits.device_lights())[i], &other = (*others.device_lights())[i];
    expect_near(one.color, other.color);
    expect_near(one.position, other.position);
    EXPECT_FLOAT_EQ(one.spot_scale, other.spot_scale);
  }
  EXPECT_EQ(others.device_materials()->front().metallic, 1.0f);
}

TEST(SceneEdits, ErrorsOfADocumentNameItsEntry) {
  protocol::EditDocument document;
  document.lights = {{"sun", {.intensity = {2.0f}}}, {"sun", {.width = {1.0f}}}};
  EXPECT_EQ(SceneEdits(a_scene()).apply(document).error().path, "edits.lights[1].patch.width");
  document.lights.clear();
  document.removed_lights = {"moon"};
  EXPECT_EQ(SceneEdits(a_scene()).apply(document).error().path, "edits.removed_lights[0]");
  document.removed_lights.clear();
  document.materials = {{"glass", {}}};
  EXPECT_EQ(SceneEdits(a_scene()).apply(document).error().path, "edits.materials[0].material");
}

}  // namespace
}  // namespace heliograph::session
