// Exports of scenes with edited materials.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/unit/scene/support/exported_scene.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

TEST(GlbExport, FactorsOfMaterials) {
  GltfBuilder builder = everything();
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  builder.json["materials"][0]["occlusionTexture"] = {{"index", 0}};
  Exported exported(builder);
  shared::Material& material = exported.material(0);
  material.base_color = {0.1f, 0.2f, 0.3f, 0.5f};
  material.metallic = 1.0f;
  material.roughness = 0.3f;
  material.emissive = {0.7f, 12.3f, 0.0f};
  material.normal_scale = 1.7f;
  material.occlusion_strength = 0.4f;
  exported.write();
  EXPECT_EQ(0, std::memcmp(&exported.after.materials[0], &material, sizeof material));
  const json written = exported.document().at("materials")[0];
  EXPECT_LE(written.at("emissiveFactor")[1], 1.0);
  EXPECT_EQ(written.at("pbrMetallicRoughness").at("baseColorFactor")[3], 0.5);
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, FactorsOfExtensionsAreWrittenWhereTheyDoSomething) {
  Exported exported(everything());
  exported.material(0).ior = 1.3f;
  MaterialLayers layers = exported.before.material_layers.empty()
                              ? MaterialLayers()
                              : exported.before.material_layers[0];
  layers.clearcoat = 0.75f;
  layers.clearcoat_roughness = 0.25f;
  layers.sheen_color = {0.5f, 0.25f, 0.0f};
  layers.iridescence = 0.5f;
  layers.iridescence_thickness_maximum = 512.0f;
  layers.anisotropy = 0.375f;
  layers.anisotropy_rotation = -1.1f;
  layers.diffuse_transmission = 0.625f;
  layers.diffuse_transmission_color = {0.25f, 1.0f, 0.5f};
  exported.changes.extensions = {layers};
  exported.write();
  ASSERT_FALSE(exported.after.material_layers.empty());
  const MaterialLayers& after = exported.after.material_layers[0];
  EXPECT_EQ(after.clearcoat, 0.75f);
  EXPECT_EQ(after.clearcoat_roughness, 0.25f);
  EXPECT_EQ(after.sheen_color, layers.sheen_color);
  EXPECT_EQ(after.iridescence, 0.5f);
  EXPECT_EQ(after.iridescence_ior, 1.3f);
  EXPECT_EQ(after.iridescence_thickness_maximum, 512.0f);
  EXPECT_EQ(after.anisotropy, 0.375f);
  EXPECT_EQ(after.anisotropy_rotation, -1.1f);
  EXPECT_EQ(after.diffuse_transmission, 0.625f);
  EXPECT_EQ(after.diffuse_transmission_color, layers.diffuse_transmission_color);
  EXPECT_EQ(exported.after.materials[0].ior, 1.3f);
  const json extensions = exported.document().at("materials")[0].at("extensions");
  EXPECT_FALSE(extensions.contains("KHR_materials_volume"));
  EXPECT_FALSE(extensions.contains("KHR_materials_specular"));
  EXPECT_FALSE(extensions.contains("KHR_materials_dispersion"));
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, EmissionUpToOneNeedsNoExtension) {
  GltfBuilder builder = everything();
  builder.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  builder.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
      {"emissiveStrength", 8}};
  Exported exported(builder);
  exported.material(0).emissive = {0.5f, 0.25f, 0.0f};
  exported.write();
  EXPECT_EQ(exported.after.materials[0].emissive, glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_FALSE(exported.document().at("materials")[0].contains("extensions"));
}

TEST(GlbExport, PrimitivesWithoutMaterialGetTheEditedOne) {
  Exported exported(triangle());
  exported.material(0).roughness = 0.25f;
  exported.write();
  EXPECT_EQ(exported.after.materials.at(0).roughness, 0.25f);
  EXPECT_EQ(exported.after.material_names.at(0), "default");
}

TEST(GlbExport, SpecularGlossinessBecomesTheCoreMaterialWhereItHasNoTextures) {
  GltfBuilder builder = everything();
  const json glossy = {{"diffuseFactor", {0.5, 0.5, 0.5, 1}}, {"glossinessFactor", 0.25}};
  builder.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = glossy;
  Exported plain(builder);
  plain.material(0).base_color = {1.0f, 0.0f, 0.0f, 1.0f};
  plain.write();
  EXPECT_EQ(plain.after.materials[0].base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(plain.after.materials[0].roughness, plain.before.materials[0].roughness);
  EXPECT_TRUE(plain.warnings.empty());

  builder.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]
              ["diffuseTexture"] = {{"index", 0}};
  Exported textured(builder);
  textured.material(0).base_color = {1.0f, 0.0f, 0.0f, 1.0f};
  textured.write();
  ASSERT_EQ(textured.warnings.size(), 1u);
  EXPECT_NE(textured.warnings[0].find("KHR_materials_pbrSpecularGlossiness"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::scene::test
