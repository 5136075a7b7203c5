#include "session/edits/material_edits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/json/codec.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/materials/materials.hpp"

namespace heliograph::session {
namespace {

using protocol::Vec3;

/// Paint, paint with a coat, glass, a leaf with a mask, and an unlit sign.
std::shared_ptr<const scene::Scene> extended_scene() {
  auto scene = std::make_shared<scene::Scene>();
  scene->materials.assign(5, scene::default_material());
  scene->material_layers.resize(5);
  scene->material_names = {"paint", "coat", "glass", "leaf", "sign"};
  scene->material_layers[1].clearcoat = 0.5f;
  scene->material_layers[2].transmission = 0.9f;
  scene->material_layers[2].thickness = 2.0f;
  scene->materials[3].flags = shared::material_alpha_mask;
  scene->material_layers[3].transmission = 1.0f;
  scene->materials[4].flags = shared::material_unlit;
  scene::build_layers(*scene);
  return scene;
}

const protocol::MaterialInfo& find(const MaterialEdits& edits, const std::string& name) {
  return *std::ranges::find(edits.list(), name, &protocol::MaterialInfo::name);
}

const shared::MaterialLayer& layer_of_material(const MaterialEdits& edits, std::size_t number) {
  return edits.device_layers()->at(edits.device()->at(number).layer);
}

TEST(MaterialEdits, ListsTheFactorsThatAMaterialCanHave) {
  const MaterialEdits edits(extended_scene());
  const auto& paint = find(edits, "paint");
  EXPECT_EQ(paint.ior, 1.5f);
  EXPECT_EQ(paint.specular_color, (Vec3{1, 1, 1}));
  EXPECT_EQ(paint.clearcoat, 0.0f);
  EXPECT_FALSE(paint.transmission || paint.dispersion || paint.alpha_cutoff);
  EXPECT_EQ(paint.thickness, 0.0f);
  EXPECT_EQ(paint.attenuation_color, (Vec3{1, 1, 1}));
  EXPECT_EQ(find(edits, "coat").clearcoat, 0.5f);
  EXPECT_EQ(find(edits, "glass").transmission, 0.9f);
  EXPECT_EQ(find(edits, "glass").attenuation_distance, 0.0f);
  EXPECT_EQ(find(edits, "leaf").alpha_cutoff, 0.5f);
  EXPECT_FALSE(find(edits, "leaf").transmission);
  const auto& sign = find(edits, "sign");
  EXPECT_FALSE(sign.ior || sign.specular || sign.thickness || sign.attenuation_distance);
}

TEST(MaterialEdits, AMaterialWithoutALayerGetsOneOfItsOwn) {
  const auto scene = extended_scene();
  MaterialEdits edits(scene);
  const auto paint = edits.patch({"paint", {.ior = {2.0f}, .clearcoat = {0.25f}}});
  ASSERT_TRUE(paint);
  EXPECT_EQ(paint->changed, (std::vector<std::string>{"ior", "clearcoat"}));
  const std::size_t count = edits.device_layers()->size();
  EXPECT_EQ(count, scene->layers.size() + 1);
  EXPECT_EQ(edits.device()->front().ior, 2.0f);
  EXPECT_EQ(layer_of_material(edits, 0).coat, 0.25f);
  EXPECT_NEAR(layer_of_material(edits, 0).dielectric, 1.0f / 9.0f, 1e-6f);
  const auto before = edits.device_layers();
  ASSERT_TRUE(edits.patch({"paint", {.clearcoat = {1.0f}}}));
  EXPECT_EQ(edits.device_layers()->size(), count) << "a layer for every value";
  EXPECT_EQ(layer_of_material(edits, 0).coat, 1.0f);
  EXPECT_EQ(before->back().coat, 0.25f) << "an older list was changed";
}

TEST(MaterialEdits, NullLeadsBackToTheLayerOfTheFile) {
  const auto scene = extended_scene();
  MaterialEdits edits(scene);
  ASSERT_TRUE(edits.patch({"coat", {.clearcoat = {1.0f}, .sheen_color = {Vec3{1, 0, 0}}}}));
  EXPECT_NE(edits.device()->at(1).layer, scene->materials[1].layer);
  const auto back = edits.patch({"coat", {.clearcoat = {{}, true}, .sheen_color = {{}, true}}});
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->changed.empty());
  EXPECT_EQ(back->clearcoat, 0.5f);
  EXPECT_EQ(edits.device()->at(1).layer, scene->materials[1].layer);
  ASSERT_TRUE(edits.patch({"coat", {.roughness = {0.5f}}}));
  EXPECT_EQ(edits.device()->at(1).layer, scene->materials[1].layer);
}

TEST(MaterialEdits, ValuesThatShowNothingNeedNoLayer) {
  MaterialEdits edits(extended_scene());
  ASSERT_TRUE(edits.patch({"paint", {.clearcoat_roughness = {0.5f}}}));
  EXPECT_EQ(edits.device()->front().layer, 0u);
  EXPECT_FALSE(edits.device_layers());
}

TEST(MaterialEdits, TransmissionKeepsWhatRaysGoBy) {
  const auto scene = extended_scene();
  MaterialEdits edits(scene);
  ASSERT_TRUE(edits.patch({"glass",
                           {.transmission = {0.5f},
                            .attenuation_distance = {2.0f},
                            .attenuation_color = {Vec3{0.5f, 1, 1}}}}));
  EXPECT_EQ(layer_of_material(edits, 2).transmission, 0.5f);
  EXPECT_NEAR(layer_of_material(edits, 2).absorption.x, std::log(2.0f), 1e-6f);
  EXPECT_EQ(edits.device()->at(2).passing, scene->materials[2].passing);
  EXPECT_EQ(edits.device()->at(2).flags, scene->materials[2].flags);
}

TEST(MaterialEdits, AnyLitMaterialMayScatterLightToItsOtherSide) {
  const auto scene = extended_scene();
  MaterialEdits edits(scene);
  const auto leaf = edits.patch(
      {"leaf",
       {.diffuse_transmission = {0.5f}, .diffuse_transmission_color = {Vec3{0.25f, 1, 0}}}});
  ASSERT_TRUE(leaf);
  EXPECT_EQ(leaf->changed,
            (std::vector<std::string>{"diffuse_transmission", "diffuse_transmission_color"}));
  EXPECT_EQ(layer_of_material(edits, 3).diffuse_transmission, 0.5f);
  EXPECT_EQ(layer_of_material(edits, 3).diffuse_tint, glm::vec3(0.25f, 1.0f, 0.0f));
  const auto sign = edits.patch({"sign", {.diffuse_transmission = {0.5f}}});
  EXPECT_EQ(sign.error().path, "patch.diffuse_transmission");
  protocol::EditDocument document;
  edits.describe_edits(document);
  MaterialEdits others(scene);
  ASSERT_TRUE(others.apply(document));
  EXPECT_EQ(edits.list(), others.list());
}

TEST(MaterialEdits, VolumesTintLightThatScattersThrough) {
  const auto scene = extended_scene();
  MaterialEdits edits(scene);
  const auto without = edits.patch({"paint",
                                    {.thickness = {0.5f},
                                     .attenuation_distance = {2.0f},
                                     .attenuation_color = {Vec3{0.25f, 1, 1}}}});
  ASSERT_TRUE(without);
  EXPECT_EQ(edits.device()->front().layer, 0u) << "no light passes yet";
  ASSERT_TRUE(edits.patch({"paint", {.diffuse_transmission = {0.5f}}}));
  EXPECT_NEAR(layer_of_material(edits, 0).absorption.x, 0.25f * std::log(4.0f), 1e-6f);
  EXPECT_EQ(layer_of_material(edits, 0).absorption.y, 0.0f);
  EXPECT_EQ(layer_of_material(edits, 0).transmission, 0.0f);
  ASSERT_TRUE(edits.patch({"leaf", {.diffuse_transmission = {1.0f}, .thickness = {1.0f}}}));
  protocol::EditDocument document;
  edits.describe_edits(document);
  MaterialEdits others(scene);
  ASSERT_TRUE(others.apply(document));
  EXPECT_EQ(edits.list(), others.list());
  EXPECT_EQ(edits.patch({"sign", {.thickness = {1.0f}}}).error().path, "patch.thickness");
}

TEST(MaterialEdits, RefusesFactorsThatAMaterialCannotHave) {
  MaterialEdits edits(extended_scene());
  const auto refused = edits.patch({"paint", {.roughness = {0.1f}, .transmission = {0.5f}}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "patch.transmission");
  EXPECT_NE(refused.error().message.find("transmits"), std::string::npos);
  EXPECT_EQ(find(edits, "paint").roughness, 1.0f) << "half a patch was applied";
  EXPECT_EQ(edits.patch({"leaf", {.transmission = {0.5f}}}).error().path, "patch.transmission");
  EXPECT_EQ(edits.patch({"sign", {.clearcoat = {0.5f}}}).error().path, "patch.clearcoat");
  EXPECT_EQ(edits.patch({"paint", {.ior = {0.5f}}}).error().path, "patch.ior");
  EXPECT_TRUE(edits.patch({"paint", {.ior = {0.0f}}}));
}

TEST(MaterialEdits, RequestsHaveTheRangesOfGltf) {
  const auto path_of = [](const char* patch) {
    const std::string text = R"({"material": "paint", "patch": )" + std::string(patch) + "}";
    const auto json = protocol::RawJson::parse(text);
    const auto request = protocol::decode<protocol::MaterialsPatch>(*json);
    return request ? std::string() : request.error().path;
  };
  EXPECT_EQ(path_of(R"({"ior": 0, "specular_color": [2, 1, 1], "thickness": 3})"), "");
  EXPECT_EQ(path_of(R"({"clearcoat": 1.1})"), "patch.clearcoat");
  EXPECT_EQ(path_of(R"({"ior": 11})"), "patch.ior");
  EXPECT_EQ(path_of(R"({"diffuse_transmission": 1.1})"), "patch.diffuse_transmission");
  EXPECT_EQ(path_of(R"({"attenuation_distance": -1})"), "patch.attenuation_distance");
  EXPECT_EQ(path_of(R"({"alpha_cutoff": 0.5})"), "patch.alpha_cutoff");
}

TEST(MaterialEdits, ADocumentLeadsToTheSameLayersInAnotherSession) {
  MaterialEdits edits(extended_scene());
  ASSERT_TRUE(edits.patch({"glass", {.thickness = {0.5f}}}));
  ASSERT_TRUE(edits.patch({"paint", {.sheen_color = {Vec3{0, 0.5f, 0}}}}));
  protocol::EditDocument document;
  edits.describe_edits(document);
  MaterialEdits others(extended_scene());
  ASSERT_TRUE(others.apply(document));
  EXPECT_EQ(edits.list(), others.list());
  EXPECT_EQ(layer_of_material(others, 0).sheen, glm::vec3(0.0f, 0.5f, 0.0f));
  EXPECT_EQ(find(others, "glass").thickness, 0.5f);
}

}  // namespace
}  // namespace heliograph::session
