// The import of KHR_materials_diffuse_transmission.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/materials/untextured.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

constexpr const char* through = "KHR_materials_diffuse_transmission";

/// `material` as the only one of a file that requires the extension.
Scene import_translucent(json material) {
  GltfBuilder builder = everything();
  builder.json["extensionsUsed"].push_back(through);
  builder.json["extensionsRequired"].push_back(through);
  builder.json["materials"][0] = std::move(material);
  return builder.import();
}

const shared::MaterialLayer& only_layer(const Scene& scene) {
  return scene.layers.at(scene.materials.at(0).layer);
}

TEST(DiffuseTransmissionLayers, HaveTheFactorsOfTheFile) {
  const Scene scene =
      import_translucent({{"extensions",
                           {{through,
                             {{"diffuseTransmissionFactor", 0.25},
                              {"diffuseTransmissionColorFactor", {1.0, 0.5, 0.125}}}}}}});
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.material_layers.at(0).diffuse_transmission, 0.25f);
  EXPECT_EQ(only_layer(scene).diffuse_transmission, 0.25f);
  EXPECT_EQ(only_layer(scene).diffuse_tint, glm::vec3(1.0f, 0.5f, 0.125f));
  EXPECT_TRUE(scatters_through(scene.layers));
  EXPECT_EQ(only_layer(scene).transmission, 0.0f);
  EXPECT_FALSE(scene.materials.at(0).flags & shared::material_alpha_blend);
}

TEST(DiffuseTransmissionLayers, HaveBothTexturesOfWhichOneIsAColour) {
  const Scene scene =
      import_translucent({{"extensions",
                           {{through,
                             {{"diffuseTransmissionFactor", 1},
                              {"diffuseTransmissionTexture", {{"index", 0}, {"texCoord", 1}}},
                              {"diffuseTransmissionColorTexture", {{"index", 0}}}}}}}});
  const shared::MaterialLayer& layer = only_layer(scene);
  const auto is_colour = [&](const shared::TextureSlot& slot) {
    return scene.images.at(scene.textures.at(slot.texture).image).srgb;
  };
  EXPECT_FALSE(is_colour(layer.diffuse_transmission_texture));
  EXPECT_EQ(layer.diffuse_transmission_texture.uv_set, 1u);
  EXPECT_TRUE(is_colour(layer.diffuse_tint_texture));
  EXPECT_EQ(layer.diffuse_tint, glm::vec3(1.0f));
  // Before the textures are there, nothing says how much passes.
  EXPECT_FALSE(scatters_through(without_textures(scene).layers));
}

TEST(DiffuseTransmissionLayers, MasksMayHaveItAndVolumesAttenuateIt) {
  const Scene scene =
      import_translucent({{"alphaMode", "MASK"},
                          {"extensions",
                           {{through, {{"diffuseTransmissionFactor", 1}}},
                            {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                            {"KHR_materials_volume",
                             {{"thicknessFactor", 0.5},
                              {"attenuationDistance", 1},
                              {"attenuationColor", {1, 0.25, 1}}}}}}});
  EXPECT_EQ(only_layer(scene).transmission, 0.0f);
  EXPECT_EQ(only_layer(scene).diffuse_transmission, 1.0f);
  EXPECT_NEAR(only_layer(scene).absorption.y, 0.5f * std::log(4.0f), 1e-6f);
}

TEST(DiffuseTransmissionLayers, AreNotThereWhereTheyDoNothing) {
  const Scene scene = import_translucent(
      {{"extensions", {{through, {{"diffuseTransmissionColorFactor", {1, 0, 0}}}}}}});
  EXPECT_EQ(scene.layers.size(), 1u);
  EXPECT_FALSE(scatters_through(scene.layers));
  EXPECT_EQ(scene.material_layers.at(0).diffuse_transmission_color, glm::vec3(1.0f, 0.0f, 0.0f));
}

}  // namespace
}  // namespace heliograph::scene::test
