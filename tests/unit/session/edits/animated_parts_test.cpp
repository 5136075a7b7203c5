#include "session/edits/animated_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "scene/gltf/materials/materials.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {
namespace {

using scene::Interpolation;
using Pointed = scene::PointedProperty;
using Keys = std::vector<float>;

/// With keys at 0 and 2 seconds.
scene::Track animated_track(Pointed property, std::uint32_t object, Keys values) {
  const auto width = static_cast<std::uint32_t>(values.size() / 2);
  const auto step = property == Pointed::visible ? Interpolation::step : Interpolation::linear;
  return {{step, width, {0.0f, 2.0f}, std::move(values)}, property, object};
}

/// Two materials, two spot lights of the file's light 7 and two instances, one each on the nodes
/// "box" and "light". One clip.
std::shared_ptr<scene::Scene> blinking_scene(std::vector<scene::Track> tracks) {
  auto scene = std::make_shared<scene::Scene>();
  scene->nodes = {{.name = "box"}, {.name = "light"}};
  scene->meshes.resize(1);
  scene->instances = {{0, 0}, {0, 1}};
  scene->materials = {scene::default_material(), scene::default_material()};
  scene->materials[1].emissive = {2.0f, 4.0f, 0.0f};
  scene->material_names = {"paint", "glow"};
  scene->material_layers.resize(2);
  scene->material_layers[1].emissive_factor = {0.5f, 1.0f, 0.0f};
  scene->material_layers[1].emissive_strength = 4.0f;
  scene::Light light;
  light.name = "spot";
  light.device = {};
  light.device.type = shared::light_spot;
  light.device.color = {8.0f, 4.0f, 0.0f};
  light.device.direction = {0.0f, -1.0f, 0.0f};
  light.device.tangent = {1.0f, 0.0f, 0.0f};
  light.device.spot_scale = 2.0f;
  light.device.spot_offset = -1.0f;  // cones of 60 and 0 degrees
  light.punctual = {.number = 7, .color = {1.0f, 0.5f, 0.0f}, .intensity = 8.0f};
  light.node = 0;
  scene->lights = {light, light};
  scene->lights[1].node = 1;
  scene->clips = {{.name = "blink", .duration = 2.0f, .channels = {}, .tracks = std::move(tracks)}};
  return scene;
}

/// A scene's parts at a time of its clip, or at rest.
class AnimatedPartsTest : public testing::Test {
 protected:
  void show(std::vector<scene::Track> tracks) {
    scene_ = blinking_scene(std::move(tracks));
    edits_ = SceneEdits(scene_);
    nodes_ = NodeState(scene_);
  }
  SceneParts rest() { return parts(nullptr, 0.0); }
  SceneParts at(double seconds) { return parts(&std::as_const(*scene_).clips[0], seconds); }
  shared::Material material_at(double seconds, std::size_t number) {
    const SceneParts parts = at(seconds);
    return parts.materials ? (*parts.materials)[number] : scene_->materials[number];
  }
  glm::vec3 light_at(double seconds, std::size_t number) {
    const SceneParts parts = at(seconds);
    return parts.lights ? (*parts.lights)[number].color : scene_->lights[number].device.color;
  }
  void patch_material(const char* name, const protocol::MaterialPatch& patch) {
    ASSERT_TRUE(edits_.patch(protocol::MaterialsPatch{name, patch}));
  }
  void patch_light(const char* name, const protocol::LightPatch& patch) {
    ASSERT_TRUE(edits_.patch(protocol::LightsPatch{name, patch}));
  }

  std::shared_ptr<scene::Scene> scene_;
  SceneEdits edits_;
  NodeState nodes_;
  AnimatedParts animated_;

 private:
  SceneParts parts(const scene::Clip* clip, double seconds) {
    return animated_.at({.scene = scene_,
                         .edited = {.lights = edits_.device_lights(),
                                    .materials = edits_.device_materials(),
                                    .layers = edits_.device_layers(),
                                    .hidden = nodes_.hidden_instances()},
                         .members = edits_.edited_members(),
                         .clip = clip,
                         .seconds = seconds});
  }
};

TEST_F(AnimatedPartsTest, AreTheEditedOnesWhereNothingAnimatesThem) {
  show({});
  EXPECT_EQ(at(1.0), SceneParts());
  protocol::MaterialPatch rough;
  rough.roughness.value = 0.25f;
  patch_material("paint", rough);
  EXPECT_EQ(at(1.0).materials, edits_.device_materials());
  EXPECT_FALSE(edits_.edited_members().materials) << "no clip animates others";
  show({animated_track(Pointed::roughness, 0, {0, 1})});
  EXPECT_EQ(rest(), SceneParts()) << "as in the file";
  EXPECT_EQ(at(1.0).lights, nullptr);
  EXPECT_EQ(at(1.0).hidden, nullptr);
}

TEST_F(AnimatedPartsTest, MaterialsFollowTheTimeAndStayTheSameListWithoutIt) {
  show({animated_track(Pointed::base_color, 0, {0, 0, 0, 1, 1, 0.5f, 0, 0.25f}),
        animated_track(Pointed::metallic, 0, {1, 0})});
  const shared::Material material = material_at(1.0, 0);
  EXPECT_EQ(material.base_color, glm::vec4(0.5f, 0.25f, 0.0f, 1.0f)) << "alpha is the file's";
  EXPECT_EQ(material.metallic, 0.5f);
  EXPECT_EQ(material.layer, 0u);
  const SceneParts paused = at(1.0);
  EXPECT_EQ(at(1.0), paused);
  EXPECT_EQ(at(3.0), paused) << "the clip has begun again";
  EXPECT_NE(at(1.5).materials, paused.materials);
  EXPECT_EQ(rest().materials, nullptr);
}

TEST_F(AnimatedPartsTest, WhatWasEditedStays) {
  show({animated_track(Pointed::roughness, 0, {0, 1}), animated_track(Pointed::metallic, 0, {0, 1}),
        animated_track(Pointed::roughness, 1, {0, 1})});
  protocol::MaterialPatch patch;
  patch.roughness.value = 0.125f;
  patch_material("paint", patch);
  EXPECT_EQ(material_at(1.0, 0).roughness, 0.125f);
  EXPECT_EQ(material_at(1.0, 0).metallic, 0.5f) << "that was not edited";
  EXPECT_EQ(material_at(1.0, 1).roughness, 0.5f) << "nor was this material";
  patch = {};
  patch.roughness.reset = true;
  patch_material("paint", patch);
  EXPECT_EQ(material_at(1.0, 0).roughness, 0.5f);
}

TEST_F(AnimatedPartsTest, EmissionIsTheProductOfFactorAndStrength) {
  show({animated_track(Pointed::emissive_strength, 1, {0, 8})});
  EXPECT_EQ(material_at(0.0, 1).emissive, glm::vec3(0.0f));
  EXPECT_EQ(material_at(2.0, 1).emissive, glm::vec3(4.0f, 8.0f, 0.0f));
  show({animated_track(Pointed::emissive, 1, {0, 0, 0, 1, 0, 0.5f})});
  EXPECT_EQ(material_at(2.0, 1).emissive, glm::vec3(4.0f, 0.0f, 2.0f));
}

TEST_F(AnimatedPartsTest, ExtensionsHaveALayerOfTheirOwn) {
  show({animated_track(Pointed::clearcoat, 1, {0, 1}),
        animated_track(Pointed::roughness, 0, {0, 1})});
  const SceneParts parts = at(1.0);
  ASSERT_TRUE(parts.materials && parts.layers);
  EXPECT_EQ((*parts.materials)[0].layer, 0u);
  const std::uint32_t layer = (*parts.materials)[1].layer;
  EXPECT_EQ(layer, parts.layers->size() - 1);
  EXPECT_EQ((*parts.layers)[layer].coat, 0.5f);
  EXPECT_NE((*at(0.0).materials)[1].layer, 0u) << "shaders stay those of scenes with layers";
  protocol::MaterialPatch patch;
  patch.clearcoat.value = 0.25f;
  patch_material("glow", patch);
  const SceneParts edited = at(1.0);
  EXPECT_EQ((*edited.layers)[(*edited.materials)[1].layer].coat, 0.25f);
}

TEST_F(AnimatedPartsTest, TexturesMoveWithinTheTransformOfTheFile) {
  show({animated_track(Pointed::texture_offset, 0, {0, 0, 1, 0.5f})});
  scene_->animated_slots = {{.material = 1, .kind = 0, .transform = {.scale = {2.0f, 3.0f}}}};
  const shared::TextureSlot slot = material_at(2.0, 1).base_color_texture;
  EXPECT_EQ(glm::vec3(slot.transform_row0), glm::vec3(2.0f, 0.0f, 1.0f));
  EXPECT_EQ(glm::vec3(slot.transform_row1), glm::vec3(0.0f, 3.0f, 0.5f));
}

TEST_F(AnimatedPartsTest, AllLightsOfOneOfTheFileFollowItsTracks) {
  show({animated_track(Pointed::light_intensity, 7, {0, 16}),
        animated_track(Pointed::light_range, 7, {2, 6}),
        animated_track(Pointed::outer_cone, 7, {1.0f, 0.5f})});
  EXPECT_EQ(light_at(0.0, 0), glm::vec3(0.0f));
  EXPECT_EQ(light_at(2.0, 0), glm::vec3(16.0f, 8.0f, 0.0f));
  EXPECT_EQ(light_at(2.0, 1), light_at(2.0, 0));
  const shared::Light light = (*at(2.0).lights)[0];
  EXPECT_EQ(light.range, 6.0f);
  EXPECT_NEAR(-light.spot_offset / light.spot_scale, std::cos(0.5f), 1e-5f);
  show({animated_track(Pointed::light_intensity, 6, {0, 16})});
  EXPECT_EQ(light_at(0.0, 0), scene_->lights[0].device.color) << "another light";
}

TEST_F(AnimatedPartsTest, ColorAndIntensityOfLightsAreEditedApart) {
  show({animated_track(Pointed::light_color, 7, {1, 0.5f, 0, 0, 0.5f, 1}),
        animated_track(Pointed::light_intensity, 7, {2, 4})});
  EXPECT_EQ(light_at(2.0, 0), glm::vec3(0.0f, 2.0f, 4.0f));
  protocol::LightPatch patch;
  patch.intensity.value = 10.0f;
  patch_light("spot", patch);
  EXPECT_EQ(light_at(2.0, 0), glm::vec3(0.0f, 5.0f, 10.0f));
  EXPECT_EQ(light_at(2.0, 1), glm::vec3(0.0f, 2.0f, 4.0f));
  patch = {};
  patch.color.value = protocol::Vec3{1.0f, 1.0f, 1.0f};
  patch.intensity.reset = true;
  patch_light("spot", patch);
  EXPECT_EQ(light_at(2.0, 0), glm::vec3(4.0f));
  ASSERT_TRUE(edits_.remove_light("spot"));
  EXPECT_EQ(light_at(2.0, 0), glm::vec3(0.0f));
}

TEST_F(AnimatedPartsTest, HiddenNodesHaveNeitherMeshesNorLight) {
  show({animated_track(Pointed::visible, 1, {1, 0})});
  EXPECT_EQ(at(1.0), SceneParts());
  const SceneParts hidden = at(2.0);
  ASSERT_TRUE(hidden.hidden);
  EXPECT_EQ(*hidden.hidden, (std::vector<bool>{false, true}));
  EXPECT_EQ(light_at(2.0, 1), glm::vec3(0.0f));
  EXPECT_EQ(light_at(2.0, 0), scene_->lights[0].device.color);
  EXPECT_EQ(at(2.0), hidden);
  const std::uint32_t box[] = {0};
  nodes_.set_visible(box, false);
  EXPECT_EQ(*at(2.0).hidden, (std::vector<bool>{true, true}));
  EXPECT_EQ(*at(1.0).hidden, (std::vector<bool>{true, false})) << "what was edited stays";
}

TEST_F(AnimatedPartsTest, NodesThatTheFileHidesAreHiddenUntilAClipShowsThem) {
  show({animated_track(Pointed::visible, 0, {0, 1})});
  scene_->nodes[0].visible = false;
  EXPECT_EQ(*rest().hidden, (std::vector<bool>{true, false}));
  EXPECT_EQ(*at(0.0).hidden, (std::vector<bool>{true, false}));
  EXPECT_EQ(at(2.0).hidden, nullptr);
}

}  // namespace
}  // namespace heliograph::session
