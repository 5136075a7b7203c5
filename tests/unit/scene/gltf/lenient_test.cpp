// What the import takes although the specification says otherwise, what it does not take, and what
// tinygltf alone would get wrong.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

bool warns(const Scene& scene, std::string_view part) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

json& primitive_of(GltfBuilder& builder) {
  return builder.json["meshes"][0]["primitives"][0];
}

TEST(Lenient, BuffersThatNothingUsesMayLackTheirData) {
  GltfBuilder builder = triangle();
  builder.glb();
  builder.json["buffers"].push_back({{"byteLength", 64}});
  builder.json["buffers"].push_back({{"byteLength", 64}, {"uri", "missing.bin"}});
  const Scene scene = builder.import();
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_TRUE(warns(scene, "buffers[1] is used by nothing"));
  EXPECT_TRUE(warns(scene, "buffers[2] is used by nothing"));
  builder.json["bufferViews"].push_back({{"buffer", 2}, {"byteLength", 64}});
  EXPECT_NE(refusal_of(builder, {}).find("buffers[2].uri: \"missing.bin\" is missing"),
            std::string::npos)
      << "missing geometry is an error, strict or not";
}

TEST(Lenient, NewerMinorVersionsLoadWithAWarning) {
  GltfBuilder builder = triangle();
  builder.json["asset"]["minVersion"] = "2.1";
  EXPECT_TRUE(warns(builder.import(), "asset.minVersion \"2.1\" is newer"));
  builder.json["asset"]["minVersion"] = "3.0";
  EXPECT_NE(refusal_of(builder).find("asset.minVersion"), std::string::npos);
}

TEST(Lenient, OfKeysAtTheSameTimeTheFirstIsUsed) {
  GltfBuilder builder = everything();
  const auto times = builder.add_accessor(std::vector<float>{0, 1, 1, 2}, 5126, "SCALAR", 4);
  const auto places =
      builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 9, 9, 9, 2, 0, 0}, 5126, "VEC3", 4);
  builder.json["animations"][0]["samplers"][0] = {{"input", times}, {"output", places}};
  const Scene scene = builder.import();
  const Channel& channel = scene.clips.at(0).channels.at(0);
  EXPECT_EQ(channel.times, (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(channel.values, (std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0}));
  EXPECT_TRUE(warns(scene, "animations[0].samplers[0].input repeats times"));
  const auto falling = builder.add_accessor(std::vector<float>{0, 2, 1, 3}, 5126, "SCALAR", 4);
  builder.json["animations"][0]["samplers"][0]["input"] = falling;
  EXPECT_NE(refusal_of(builder).find("must ascend"), std::string::npos);
}

TEST(Lenient, TooWideViewsAreClamped) {
  GltfBuilder builder = everything();
  builder.json["cameras"][0]["perspective"]["yfov"] = 4;
  const Scene scene = builder.import();
  EXPECT_NEAR(scene.cameras.at(0).vertical_fov, 179.0f, 0.01f);
  EXPECT_TRUE(warns(scene, "cameras[0].perspective.yfov is too large"));
}

TEST(Lenient, AnEmptyWebpExtensionLeavesTheTexturesOwnSource) {
  GltfBuilder builder = everything();
  builder.json["textures"][0]["extensions"]["EXT_texture_webp"] = json::object();
  EXPECT_EQ(builder.import().images.at(0).width, 2u);
}

TEST(Lenient, AListedNodeWithAParentIsDrawnOnceWhereItsParentPutsIt) {
  GltfBuilder builder = triangle();
  builder.json["nodes"][0]["translation"] = {1, 0, 0};
  const auto parent = builder.add("nodes", {{"children", {0}}, {"translation", {0, 5, 0}}});
  builder.json["scenes"][0]["nodes"] = {0, parent};
  const Scene scene = builder.import();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(glm::vec3(scene.nodes[scene.instances[0].node].world[3]), glm::vec3(1, 5, 0));
  EXPECT_TRUE(warns(scene, "scenes[0].nodes lists nodes[0]"));
  builder.json["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(builder.import().instances.size(), 1u) << "its parent is not shown";
}

TEST(Lenient, MaterialsAreShownWithoutImagesThatAreMissingOrDamaged) {
  Bytes cut = png(16, 16, 4, Bytes(1024, 9));
  cut.resize(cut.size() / 2);
  GltfBuilder missing = everything();
  missing.json["images"][0] = {{"uri", "missing.png"}, {"name", "bricks"}};
  GltfBuilder damaged = everything();
  damaged.json["images"][0]["bufferView"] = damaged.add_view(cut);
  for (const GltfBuilder& builder : {missing, damaged}) {
    const Scene scene = builder.import();
    const shared::Material& material = scene.materials.at(0);
    ASSERT_NE(material.base_color_texture.texture, shared::no_texture);
    const Image& image = scene.images.at(scene.textures[material.base_color_texture.texture].image);
    EXPECT_EQ(image.pixels, Bytes(4, 255));
    EXPECT_EQ(material.normal_texture.texture, shared::no_texture);
    EXPECT_TRUE(warns(scene, "images[0]"));
    EXPECT_NE(refusal_of(builder, strict_limits).find("images[0]"), std::string::npos);
  }
  EXPECT_TRUE(warns(missing.import(), "\"missing.png\" is missing"));
}

TEST(Lenient, OtherMaterialExtensionsAreLeftOutUnlessRequired) {
  const std::string extension = "KHR_materials_subsurface";
  GltfBuilder builder = everything();
  builder.json["extensionsUsed"].push_back(extension);
  builder.json["materials"][0]["extensions"][extension] = {{"scatterDistance", 0.5}};
  EXPECT_TRUE(warns(builder.import(), '"' + extension + "\" is ignored"));
  builder.json["extensionsRequired"] = {extension};
  EXPECT_NE(refusal_of(builder).find("not supported: \"" + extension + '"'), std::string::npos);
}

TEST(Strict, PositionsOfIntegersNeedTheExtension) {
  GltfBuilder builder = triangle();
  const auto view = builder.add_view(Bytes{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 4);
  primitive_of(builder)["attributes"]["POSITION"] = builder.add_accessor(view, 5121, "VEC3", 3);
  EXPECT_NE(refusal_of(builder).find("without KHR_mesh_quantization"), std::string::npos);
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(refusal_of(builder), "");
}

TEST(Strict, NodesHaveAMatrixOrItsParts) {
  GltfBuilder builder = triangle();
  builder.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(refusal_of(builder), "");
  builder.json["nodes"][0]["scale"] = {1, 1, 1};
  EXPECT_EQ(refusal_of(builder), "nodes[0].scale: must not be beside a matrix");
}

// tinygltf alone: wraps the first, and takes the others for absent.
TEST(Document, NumbersAreNeitherNarrowedNorReplaced) {
  GltfBuilder builder = triangle();
  primitive_of(builder)["indices"] = 4294967296u;
  EXPECT_NE(refusal_of(builder).find("4294967296 is not an index into 1 accessors"),
            std::string::npos);
  primitive_of(builder)["indices"] = "0";
  EXPECT_NE(refusal_of(builder).find("whole number"), std::string::npos);
  primitive_of(builder).erase("indices");
  builder.json["nodes"][0]["translation"] = {1, "2", 3};
  EXPECT_NE(refusal_of(builder).find("nodes[0].translation: must be an array of 3 numbers"),
            std::string::npos);
}

TEST(Document, WholeNumbersMayBeWrittenWithAFraction) {
  GltfBuilder builder = triangle();
  builder.json["nodes"][0]["mesh"] = 0.0;
  builder.json["accessors"][0]["count"] = 3.0;
  builder.json["bufferViews"][0]["byteLength"] = 36.0;
  EXPECT_EQ(builder.import().triangle_count(), 1u);
}

// tinygltf drops empty objects of arrays in extensions.
TEST(Document, VariantsWithoutNamesKeepTheirPlaces) {
  GltfBuilder builder = triangle();
  builder.add("materials", {{"name", "own"}});
  builder.add("materials", {{"name", "other"}});
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = {json::object(),
                                                                      {{"name", "second"}}};
  primitive_of(builder)["material"] = 0;
  primitive_of(builder)["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {1}}}};
  const Scene scene = builder.import({}, {.variant = "second"});
  EXPECT_EQ(scene.variants, (std::vector<std::string>{"", "second"}));
  EXPECT_EQ(scene.meshes.at(0).material, 1u);
}

// tinygltf refuses indices without a buffer view, and drops channels without a node.
TEST(Document, WhatTheSpecificationPermitsLoads) {
  GltfBuilder builder = everything();
  builder.json["accessors"][3].erase("bufferView");
  builder.json["animations"][0]["channels"].push_back(
      {{"sampler", 0}, {"target", {{"path", "translation"}}}});
  builder.json["extensions"]["KHR_lights_punctual"]["lights"][0] = {{"type", "spot"}};
  const Scene scene = builder.import();
  EXPECT_EQ(scene.meshes.at(0).indices, std::vector<std::uint32_t>(6, 0));
  EXPECT_EQ(scene.clips.at(0).channels.size(), 1u);
  EXPECT_EQ(scene.lights.at(0).device.type, shared::light_spot);
}

TEST(Document, NodesThatAreNotVisibleKeepTheirCamerasOnly) {
  GltfBuilder builder = everything();
  builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  const Scene scene = builder.import();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(scene.lights.empty()) << "it is below the node";
  EXPECT_EQ(scene.cameras.size(), 1u);
  builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(builder.import().instances.size(), 1u);
}

}  // namespace
}  // namespace heliograph::scene::test
