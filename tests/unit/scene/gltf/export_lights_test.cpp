// Exports of scenes with edited lights.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/scene/support/exported_scene.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

/// A triangle with lights of all punctual types; the last two share one, below a scaled node.
GltfBuilder lit() {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}},
      {{"type", "point"}, {"intensity", 20}, {"range", 9}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
  builder.add("nodes", {{"name", "sun"}, {"extensions", light(0)}, {"children", {2}}});
  builder.add("nodes", {{"name", "bulb"}, {"extensions", light(1)}, {"translation", {1, 2, 3}}});
  builder.add(
      "nodes",
      {{"name", "rig"}, {"scale", {2, 2, 2}}, {"translation", {0, 5, 0}}, {"children", {4, 5}}});
  builder.add("nodes", {{"name", "left"}, {"extensions", light(2)}, {"translation", {-1, 0, 0}}});
  builder.add("nodes", {{"name", "right"}, {"extensions", light(2)}, {"translation", {1, 0, 0}}});
  builder.json["scenes"][0]["nodes"] = {0, 1, 3};
  return builder;
}

TEST(GlbExport, LightsKeepTheirNodesWhereOnlyTheirLightDiffers) {
  Exported exported(lit());
  exported.edit_lights();
  exported.light(1).color = {10.0f, 5.0f, 2.5f};
  exported.light(1).range = 0.0f;
  exported.light(1).radius = 0.2f;
  exported.light(2).color = glm::vec3(7.0f);
  exported.changes.lights[3].off = true;
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.document().at("nodes").size(), 6u);
  const shared::Light& bulb = exported.after.lights[1].device;
  expect_near(bulb.color, {10.0f, 5.0f, 2.5f});
  EXPECT_EQ(bulb.range, 0.0f);
  EXPECT_FLOAT_EQ(bulb.radius, 0.2f);
  EXPECT_EQ(bulb.position, exported.before.lights[1].device.position);
  expect_near(exported.after.lights[2].device.color, glm::vec3(7.0f));
  EXPECT_EQ(exported.after.lights[3].device.color, glm::vec3(0.0f)) << "shared it, and is off";
}

TEST(GlbExport, MovedLightsTakeTheirNodesAlongOrBecomeChildren) {
  Exported exported(lit());
  exported.edit_lights();
  const glm::vec3 aside = glm::normalize(glm::vec3(1.0f, -1.0f, 0.5f));
  exported.light(0).direction = aside;
  exported.light(0).tangent = glm::normalize(glm::cross(aside, glm::vec3(0, 1, 0)));
  exported.light(1).position = {4.0f, 4.0f, 4.0f};
  exported.light(2).position = {-3.0f, 1.0f, 2.0f};
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.document().at("nodes").size(), 7u) << "one child of the sun, which has one";
  EXPECT_EQ(exported.after.nodes.size(), 7u);
  const auto found = [&](const std::string& name) {
    return *std::ranges::find(exported.after.lights, name, &Light::name);
  };
  expect_near(found("sun").device.direction, aside);
  expect_near(found("bulb").device.position, {4.0f, 4.0f, 4.0f});
  expect_near(found("left").device.position, {-3.0f, 1.0f, 2.0f});
  expect_near(found("right").device.position, exported.before.lights[3].device.position);
  EXPECT_FLOAT_EQ(found("left").device.spot_scale, exported.before.lights[2].device.spot_scale);
  EXPECT_FLOAT_EQ(found("sun").device.radius, exported.before.lights[0].device.radius);
}

TEST(GlbExport, RemovedLightsLeaveTheirNodesAndAddedOnesGetNew) {
  Exported exported(lit());
  exported.edit_lights();
  exported.changes.lights[1].removed = true;
  shared::Light spot = exported.light(2);
  spot.position = {9.0f, 8.0f, 7.0f};
  spot.direction = {0.0f, 0.0f, 1.0f};
  spot.color = {1.0f, 4.0f, 2.0f};
  spot.radius = 0.125f;
  exported.changes.lights.push_back({.name = "new spot", .device = spot});
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.after.nodes.size(), 7u);
  const Light& added = *std::ranges::find(exported.after.lights, "new spot", &Light::name);
  EXPECT_EQ(added.device.position, spot.position);
  expect_near(added.device.direction, spot.direction);
  expect_near(added.device.tangent, spot.tangent);
  expect_near(added.device.color, spot.color);
  EXPECT_NEAR(added.device.spot_scale, spot.spot_scale, 1e-3f);
  EXPECT_NEAR(added.device.spot_offset, spot.spot_offset, 1e-3f);
  EXPECT_EQ(added.device.radius, 0.125f);
}

TEST(GlbExport, SceneWithoutLightsGetsSome) {
  Exported exported(triangle());
  shared::Light sun{};
  sun.type = shared::light_directional;
  sun.direction = {0.0f, -1.0f, 0.0f};
  sun.tangent = {1.0f, 0.0f, 0.0f};
  sun.color = glm::vec3(3.0f);
  sun.radius = 0.01f;
  shared::Light panel = sun;
  panel.type = shared::light_rectangle;
  panel.half_width = 1.5f;
  panel.half_height = 0.5f;
  panel.position = {0.0f, 3.0f, 0.0f};
  exported.changes.lights = {{.name = "sun", .device = sun}, {.name = "panel", .device = panel}};
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 2u);
  EXPECT_NEAR(exported.after.lights[0].device.radius, 0.01f, 1e-6f);
  EXPECT_EQ(exported.after.lights[1].device.half_width, 1.5f);
  expect_near(exported.after.lights[1].device.direction, panel.direction);
  EXPECT_EQ(exported.document().at("extensionsUsed"), json({"KHR_lights_punctual"}));
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("\"panel\""), std::string::npos);
}

TEST(GlbExport, AreaLightsAreChangedInExtras) {
  GltfBuilder builder = triangle();
  builder.add("nodes",
              {{"name", "panel"},
               {"extras", {{"areaLight", {{"shape", "disk"}, {"radius", 1}}}, {"note", "stays"}}}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  Exported exported(builder);
  exported.edit_lights();
  exported.light(0).color = {2.0f, 1.0f, 1.0f};
  exported.light(0).radius = 0.5f;
  exported.light(0).position = {0.0f, 1.0f, 0.0f};
  exported.write();
  const shared::Light& light = exported.after.lights.at(0).device;
  EXPECT_EQ(light.type, shared::light_disk);
  expect_near(light.color, {2.0f, 1.0f, 1.0f});
  EXPECT_EQ(light.radius, 0.5f);
  expect_near(light.position, {0.0f, 1.0f, 0.0f});
  EXPECT_EQ(exported.document().at("nodes")[1].at("extras").at("note"), "stays");
  EXPECT_EQ(exported.warnings.size(), 1u);
}

}  // namespace
}  // namespace heliograph::scene::test
