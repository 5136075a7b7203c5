#include "session/edits/scene_export.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

using Nodes = std::vector<std::uint32_t>;

/// A light, and meshes on the nodes 0, 1 below it, 2 below that, and 3.
std::shared_ptr<const scene::Scene> a_scene_to_export() {
  auto scene = std::make_shared<scene::Scene>();
  scene->nodes.resize(4);
  scene->nodes[1].parent = 0;
  scene->nodes[2].parent = 1;
  scene->meshes.resize(1);
  for (std::uint32_t node = 0; node < 4; ++node) scene->instances.push_back({0, node});
  scene::Light light;
  light.name = "light";
  light.device = {};
  light.device.type = shared::light_point;
  light.device.color = {4.0f, 2.0f, 1.0f};
  light.device.direction = {0.0f, -1.0f, 0.0f};
  light.device.tangent = {1.0f, 0.0f, 0.0f};
  scene->lights = {light};
  scene->materials.emplace_back();
  scene->material_names = {"paint"};
  return scene;
}

struct Parts {
  std::shared_ptr<const scene::Scene> scene = a_scene_to_export();
  SceneEdits edits{scene};
  NodeState nodes{scene};
  SectionPlanes section;

  SceneExport made(bool other_environment = false) const {
    return make_export(scene, edits, nodes, section, other_environment);
  }
};

TEST(SceneExport, WithoutEditsNothingChanges) {
  const SceneExport made = Parts().made();
  EXPECT_TRUE(made.changes.materials.empty());
  EXPECT_TRUE(made.changes.lights.empty());
  EXPECT_TRUE(made.changes.hidden.empty());
  EXPECT_TRUE(made.warnings.empty());
}

TEST(SceneExport, LightsThatAreOffKeepTheirColour) {
  Parts parts;
  ASSERT_TRUE(parts.edits.patch(
      protocol::LightsPatch{.light = "light", .patch = {.enabled = {.value = false}}}));
  protocol::LightPatch off;
  off.enabled.value = false;
  off.intensity.value = 7.0f;
  ASSERT_TRUE(parts.edits.add(
      protocol::LightAdd{.type = protocol::LightType::spot, .name = "new", .patch = off}));
  const auto lights = parts.made().changes.lights;
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_TRUE(lights[0].off);
  EXPECT_EQ(lights[0].device.color, glm::vec3(4.0f, 2.0f, 1.0f));
  EXPECT_EQ(lights[1].name, "new");
  EXPECT_TRUE(lights[1].off);
  EXPECT_EQ(lights[1].device.color, glm::vec3(7.0f));
  ASSERT_TRUE(parts.edits.remove_light("light"));
  EXPECT_TRUE(parts.made().changes.lights[0].removed);
}

TEST(SceneExport, MaterialsAreThoseOfTheSession) {
  Parts parts;
  ASSERT_TRUE(parts.edits.patch(
      protocol::MaterialsPatch{.material = "paint", .patch = {.roughness = {.value = 0.5f}}}));
  ASSERT_EQ(parts.made().changes.materials.size(), 1u);
  EXPECT_EQ(parts.made().changes.materials[0].roughness, 0.5f);
  ASSERT_EQ(parts.made().changes.extensions.size(), 1u);
  EXPECT_FALSE(parts.made().changes.extensions[0]) << "as in the file";
  ASSERT_TRUE(parts.edits.patch(
      protocol::MaterialsPatch{.material = "paint", .patch = {.clearcoat = {.value = 0.5f}}}));
  ASSERT_TRUE(parts.made().changes.extensions[0]);
  EXPECT_EQ(parts.made().changes.extensions[0]->clearcoat, 0.5f);
}

TEST(SceneExport, IsolatedNodesHideAllOthers) {
  Parts parts;
  parts.nodes.isolate(Nodes{2});
  const SceneExport made = parts.made();
  EXPECT_EQ(made.changes.hidden, Nodes{3}) << "those above would hide it, too";
  EXPECT_EQ(made.warnings.size(), 1u) << "and have meshes";
  parts.nodes.isolate(Nodes{0});
  EXPECT_TRUE(parts.made().warnings.empty());
  parts.nodes.set_visible(Nodes{1}, false);
  EXPECT_EQ(parts.made().changes.hidden, (Nodes{1, 3}));
}

TEST(SceneExport, TellsWhatNoFileHolds) {
  Parts parts;
  protocol::Section section;
  section.planes.push_back({.normal = {1, 0, 0}});
  ASSERT_TRUE(parts.section.set(section));
  const SceneExport made = parts.made(true);
  ASSERT_EQ(made.warnings.size(), 2u);
  EXPECT_NE(made.warnings[0].find("section planes"), std::string::npos);
  EXPECT_NE(made.warnings[1].find("environment"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::session
