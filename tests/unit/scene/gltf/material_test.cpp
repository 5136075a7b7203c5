#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf/materials/materials.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

GltfBuilder with_material(json material) {
  GltfBuilder builder = everything();
  builder.json["materials"][0] = std::move(material);
  return builder;
}

TEST(Materials, EmptyMaterialHasDefaults) {
  const Scene scene = with_material(json::object()).import();
  ASSERT_EQ(scene.materials.size(), 1u);
  const shared::Material& material = scene.materials[0];
  EXPECT_EQ(material.base_color, glm::vec4(1.0f));
  EXPECT_EQ(material.metallic, 1.0f);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.emissive, glm::vec3(0.0f));
  EXPECT_EQ(material.ior, 1.5f);
  EXPECT_EQ(material.flags, 0u);
  EXPECT_EQ(material.base_color_texture.texture, shared::no_texture);
  EXPECT_EQ(material.alpha_mask, shared::no_texture);
  EXPECT_TRUE(scene.images.empty()) << "unused images are not decoded";
}

TEST(Materials, FactorsAndFlags) {
  const Scene scene =
      with_material({{"name", "paint"},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {.1, .2, .3, .4}},
                       {"metallicFactor", .5},
                       {"roughnessFactor", .25}}},
                     {"emissiveFactor", {1, .5, 0}},
                     {"alphaMode", "BLEND"},
                     {"doubleSided", true},
                     {"extensions",
                      {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}},
                       {"KHR_materials_ior", {{"ior", 1.33}}},
                       {"KHR_materials_unlit", json::object()}}}})
          .import();
  const shared::Material& material = scene.materials[0];
  EXPECT_EQ(scene.material_names[0], "paint");
  EXPECT_FLOAT_EQ(material.base_color.w, 0.4f);
  EXPECT_FLOAT_EQ(material.metallic, 0.5f);
  EXPECT_FLOAT_EQ(material.roughness, 0.25f);
  EXPECT_EQ(material.emissive, glm::vec3(10.0f, 5.0f, 0.0f));
  EXPECT_FLOAT_EQ(material.ior, 1.33f);
  EXPECT_EQ(material.flags,
            shared::material_alpha_blend | shared::material_double_sided | shared::material_unlit);
}

TEST(Materials, SlotsKeepTexCoordSetAndStrength) {
  GltfBuilder builder =
      with_material({{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}}},
                       {"metallicRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}}},
                     {"normalTexture", {{"index", 0}, {"scale", .7}}},
                     {"occlusionTexture", {{"index", 0}, {"strength", .3}, {"texCoord", 1}}},
                     {"emissiveTexture", {{"index", 0}}}});
  const Scene scene = builder.import();
  const shared::Material& material = scene.materials[0];
  EXPECT_FLOAT_EQ(material.normal_scale, 0.7f);
  EXPECT_FLOAT_EQ(material.occlusion_strength, 0.3f);
  EXPECT_EQ(material.metallic_roughness_texture.uv_set, 1u);
  EXPECT_EQ(material.occlusion_texture.uv_set, 1u);
  EXPECT_EQ(material.base_color_texture.uv_set, 0u);
  // One image used as color and as data: two images and two textures.
  ASSERT_EQ(scene.images.size(), 2u);
  ASSERT_EQ(scene.textures.size(), 2u);
  const auto srgb = [&](const shared::TextureSlot& slot) {
    return scene.images[scene.textures[slot.texture].image].srgb;
  };
  EXPECT_TRUE(srgb(material.base_color_texture));
  EXPECT_TRUE(srgb(material.emissive_texture));
  EXPECT_FALSE(srgb(material.metallic_roughness_texture));
  EXPECT_FALSE(srgb(material.normal_texture));
  EXPECT_FALSE(srgb(material.occlusion_texture));
  EXPECT_EQ(scene.textures[0].sampler.wrap_s, shared::wrap_clamp);
  EXPECT_EQ(scene.textures[0].sampler.wrap_t, shared::wrap_repeat);
}

TEST(Materials, TextureTransformScalesRotatesThenTranslates) {
  GltfBuilder builder = everything();
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform",
       {{"offset", {.5, .25}}, {"rotation", 1.57079632679}, {"scale", {2, 3}}, {"texCoord", 1}}}};
  const shared::TextureSlot slot = builder.import().materials[0].base_color_texture;
  EXPECT_EQ(slot.uv_set, 1u);
  const glm::vec3 uv(1.0f, 0.0f, 1.0f);
  // A counter-clockwise rotation by 90 degrees with v down takes +u to -v.
  EXPECT_NEAR(glm::dot(glm::vec3(slot.transform_row0), uv), 0.5f, 1e-6f);
  EXPECT_NEAR(glm::dot(glm::vec3(slot.transform_row1), uv), 0.25f - 2.0f, 1e-6f);
}

TEST(Materials, OutOfRangeFactorsAreClampedWithWarning) {
  const Scene scene = with_material({{"pbrMetallicRoughness", {{"roughnessFactor", 3}}}}).import();
  EXPECT_EQ(scene.materials[0].roughness, 1.0f);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("materials[0].pbrMetallicRoughness.roughnessFactor"),
            std::string::npos);
}

TEST(Materials, WarningNamesUnsupportedExtension) {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_materials_subsurface"};
  const Scene scene = builder.import();
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("KHR_materials_subsurface"), std::string::npos);
}

TEST(Materials, LayersAreReadAndApproximationIsWarned) {
  const GltfBuilder builder =
      with_material({{"extensions",
                      {{"KHR_materials_specular",
                        {{"specularFactor", 0.25}, {"specularColorFactor", {1, 2, 0.5}}}},
                       {"KHR_materials_clearcoat",
                        {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.125}}},
                       {"KHR_materials_sheen",
                        {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.5}}},
                       {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 0.5},
                         {"attenuationDistance", 2},
                         {"attenuationColor", {1, 0.5, 0.25}}}}}}});
  const Scene scene = builder.import();
  const MaterialLayers& layers = scene.material_layers.at(0);
  EXPECT_EQ(layers.specular, 0.25f);
  EXPECT_EQ(layers.specular_color, glm::vec3(1.0f, 2.0f, 0.5f));
  EXPECT_EQ(layers.clearcoat, 0.75f);
  EXPECT_EQ(layers.clearcoat_roughness, 0.125f);
  EXPECT_EQ(layers.sheen_color, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(layers.sheen_roughness, 0.5f);
  EXPECT_EQ(layers.transmission, 1.0f);
  EXPECT_EQ(layers.thickness, 0.5f);
  EXPECT_EQ(layers.attenuation_distance, 2.0f);
  EXPECT_EQ(layers.attenuation_color, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_TRUE(scene.warnings.empty());
  // What attenuates light along its way, and over the thickness that the material states.
  const shared::MaterialLayer& layer = scene.layers.at(scene.materials.at(0).layer);
  EXPECT_NEAR(layer.attenuation.y, 0.5f * std::log(2.0f), 1e-6f);
  EXPECT_NEAR(layer.absorption.y, 0.25f * std::log(2.0f), 1e-6f);
  EXPECT_EQ(layer.refraction, 1.5f);
}

TEST(Materials, OutOfRangeLayersAreRejected) {
  const auto refusal_with = [](const char* extension, const nlohmann::json& value) {
    return refusal_of(with_material({{"extensions", {{extension, value}}}}));
  };
  const auto expect = [](const std::string& refusal, std::string_view part) {
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
  };
  expect(refusal_with("KHR_materials_specular", {{"specularFactor", 2}}), "from 0 to 1");
  expect(refusal_with("KHR_materials_specular", {{"specularColorFactor", {1, -1, 1}}}), "negative");
  expect(refusal_with("KHR_materials_clearcoat", {{"clearcoatFactor", -1}}), "negative");
  expect(refusal_with("KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 9}}}}),
         "clearcoatTexture.index: 9");
  expect(refusal_with("KHR_materials_sheen", {{"sheenColorFactor", {2, 0, 0}}}), "from 0 to 1");
  expect(refusal_with("KHR_materials_transmission", {{"transmissionFactor", "all"}}), "number");
  expect(refusal_with("KHR_materials_volume", {{"attenuationDistance", 0}}), "more than 0");
  expect(refusal_with("KHR_materials_volume", {{"thicknessFactor", -3}}), "negative");
  expect(refusal_with("KHR_materials_volume", 5), "must be an object");
  expect(refusal_with("KHR_materials_iridescence", {{"iridescenceFactor", 1.5}}), "from 0 to 1");
  expect(refusal_with("KHR_materials_iridescence", {{"iridescenceIor", 0.5}}), "iridescenceIor");
  expect(refusal_with("KHR_materials_iridescence", {{"iridescenceThicknessMinimum", -1}}),
         "negative");
  expect(refusal_with("KHR_materials_iridescence", {{"iridescenceThicknessMaximum", "thick"}}),
         "number");
  expect(refusal_with("KHR_materials_iridescence", {{"iridescenceTexture", {{"index", 9}}}}),
         "iridescenceTexture.index: 9");
  expect(refusal_with("KHR_materials_anisotropy", {{"anisotropyStrength", -0.5}}), "negative");
  expect(refusal_with("KHR_materials_anisotropy", {{"anisotropyRotation", "x"}}), "number");
  expect(refusal_with("KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 9}}}}),
         "anisotropyTexture.index: 9");
  expect(refusal_with("KHR_materials_dispersion", {{"dispersion", -1}}), "negative");
}

/// The shading layer of the only material.
shared::MaterialLayer shading_layer(const Scene& scene) {
  return scene.layers.at(scene.materials.at(0).layer);
}

TEST(Layers, DefaultsForPlainMaterials) {
  const Scene scene = with_material({{"name", "plain"}}).import();
  EXPECT_EQ(scene.layers.size(), 1u);
  EXPECT_EQ(shading_layer(scene).dielectric, 0.04f);
  const Scene usual = with_material({{"extensions",
                                      {{"KHR_materials_ior", {{"ior", 1.5}}},
                                       {"KHR_materials_specular", {{"specularFactor", 1.0}}}}}})
                          .import();
  EXPECT_EQ(usual.layers.size(), 1u) << "explicit defaults add no layer";
}

TEST(Layers, IorSpecularFactorAndColor) {
  const Scene scene =
      with_material({{"extensions",
                      {{"KHR_materials_ior", {{"ior", 2.0}}},
                       {"KHR_materials_specular",
                        {{"specularFactor", 0.5}, {"specularColorFactor", {0.5, 1, 30}}}}}}})
          .import();
  const shared::MaterialLayer layer = shading_layer(scene);
  EXPECT_NEAR(layer.dielectric, 1.0f / 9.0f, 1e-6f);
  EXPECT_EQ(layer.specular_color, glm::vec3(0.5f, 1.0f, 30.0f));
  EXPECT_EQ(layer.specular, 0.5f);
}

TEST(Layers, ClearcoatAndSheenFactors) {
  const Scene scene =
      with_material({{"extensions",
                      {{"KHR_materials_clearcoat",
                        {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.2}}},
                       {"KHR_materials_sheen",
                        {{"sheenColorFactor", {1, 0.5, 0.25}}, {"sheenRoughnessFactor", 0.75}}}}}})
          .import();
  EXPECT_FLOAT_EQ(shading_layer(scene).coat, 0.8f);
  EXPECT_FLOAT_EQ(shading_layer(scene).coat_roughness, 0.2f);
  EXPECT_EQ(shading_layer(scene).sheen, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(shading_layer(scene).sheen_roughness, 0.75f);
}

TEST(Layers, TexturesHaveColorSpaceOfTheirExtension) {
  const auto slot = [](int set) { return nlohmann::json{{"index", 0}, {"texCoord", set}}; };
  nlohmann::json normal = slot(1);
  normal["scale"] = 0.5;
  GltfBuilder builder =
      with_material({{"extensions",
                      {{"KHR_materials_specular",
                        {{"specularTexture", slot(0)}, {"specularColorTexture", slot(1)}}},
                       {"KHR_materials_clearcoat",
                        {{"clearcoatFactor", 1},
                         {"clearcoatTexture", slot(0)},
                         {"clearcoatRoughnessTexture", slot(1)},
                         {"clearcoatNormalTexture", normal}}},
                       {"KHR_materials_sheen",
                        {{"sheenColorFactor", {1, 1, 1}},
                         {"sheenColorTexture", slot(0)},
                         {"sheenRoughnessTexture", slot(1)}}},
                       {"KHR_materials_transmission",
                        {{"transmissionFactor", 1}, {"transmissionTexture", slot(1)}}},
                       {"KHR_materials_volume", {{"thicknessTexture", slot(0)}}},
                       {"KHR_materials_iridescence",
                        {{"iridescenceFactor", 1},
                         {"iridescenceTexture", slot(1)},
                         {"iridescenceThicknessTexture", slot(0)}}},
                       {"KHR_materials_anisotropy",
                        {{"anisotropyStrength", 1}, {"anisotropyTexture", slot(1)}}}}}});
  const Scene scene = builder.import();
  const shared::MaterialLayer layer = shading_layer(scene);
  const auto expect = [&](const shared::TextureSlot& drawn, bool srgb, std::uint32_t set) {
    ASSERT_NE(drawn.texture, shared::no_texture);
    EXPECT_EQ(scene.images[scene.textures[drawn.texture].image].srgb, srgb);
    EXPECT_EQ(drawn.uv_set, set);
  };
  expect(layer.specular_texture, false, 0);
  expect(layer.specular_color_texture, true, 1);
  expect(layer.coat_texture, false, 0);
  expect(layer.coat_roughness_texture, false, 1);
  expect(layer.coat_normal_texture, false, 1);
  expect(layer.sheen_color_texture, true, 0);
  expect(layer.sheen_roughness_texture, false, 1);
  expect(layer.transmission_texture, false, 1);
  expect(layer.thickness_texture, false, 0);
  expect(layer.iridescence_texture, false, 1);
  expect(layer.film_texture, false, 0);
  expect(layer.anisotropy_texture, false, 1);
  EXPECT_EQ(layer.coat_normal_scale, 0.5f);
}

TEST(Layers, TransmissionMakesSurfaceBlended) {
  const Scene scene =
      with_material(
          {{"pbrMetallicRoughness",
            {{"metallicFactor", 0.0}, {"baseColorFactor", {1, 1, 1, 0.25}}}},
           {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}})
          .import();
  const shared::Material& material = scene.materials[0];
  EXPECT_TRUE(material.flags & shared::material_alpha_blend);
  EXPECT_TRUE(material.flags & shared::material_whole_alpha)
      << "alphaMode is OPAQUE: alpha is ignored";
  EXPECT_EQ(material.base_color.w, 1.0f);
  EXPECT_NEAR(material.passing, 0.5f, 1e-6f);
  EXPECT_EQ(shading_layer(scene).transmission, 0.5f);
}

TEST(Layers, MaskedMaterialsHaveNoTransmission) {
  const Scene scene =
      with_material({{"alphaMode", "MASK"},
                     {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}})
          .import();
  EXPECT_FALSE(scene.materials[0].flags & shared::material_alpha_blend);
  EXPECT_EQ(scene.layers.size(), 1u);
}

TEST(Materials, VariantsAreListedAndDefaultIsUsed) {
  GltfBuilder builder = with_material({{"name", "plain"}});
  builder.add("materials", {{"name", "golden"}});
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "beach"}},
                                                                      {{"name", "night"}}};
  auto& mappings =
      builder
          .json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"];
  mappings = {{{"material", 1}, {"variants", {0, 1}}}};
  const Scene scene = builder.import();
  EXPECT_EQ(scene.variants, (std::vector<std::string>{"beach", "night"}));
  EXPECT_EQ(scene.material_names[scene.meshes[0].material], "plain");
  EXPECT_EQ(scene.variant, std::nullopt);
  const Scene golden = builder.import({}, {.scene = "", .variant = "night"});
  EXPECT_EQ(golden.material_names[golden.meshes[0].material], "golden");
  EXPECT_EQ(golden.variant, 1u);
  mappings[0]["variants"] = {0};
  const Scene unmapped = builder.import({}, {.scene = "", .variant = "night"});
  EXPECT_EQ(unmapped.material_names[unmapped.meshes[0].material], "plain");
  EXPECT_THROW(builder.import({}, {.scene = "", .variant = "day"}), NoSuchChoice);
  mappings[0]["variants"] = {2};
  EXPECT_NE(refusal_of(builder).find("variants: 2 is not an index"), std::string::npos);
  mappings[0]["variants"] = {1, 1};
  EXPECT_NE(refusal_of(builder).find("twice"), std::string::npos);
  mappings[0] = {{"material", 7}, {"variants", {0}}};
  EXPECT_NE(refusal_of(builder).find("material: 7"), std::string::npos);
}

TEST(Materials, TextureInUnsupportedFormatIsSkipped) {
  GltfBuilder builder = everything();
  builder.json["textures"][0].erase("source");
  const Scene scene = builder.import();
  EXPECT_EQ(scene.materials[0].base_color_texture.texture, shared::no_texture);
  EXPECT_FALSE(scene.warnings.empty());
}

TEST(Materials, MaskedAlphaIsPackedForRays) {
  GltfBuilder builder = everything();
  const Bytes pixels = {1, 2, 3, 10, 1, 2, 3, 20, 1, 2, 3, 30,
                        1, 2, 3, 40, 1, 2, 3, 50, 1, 2, 3, 60};
  builder.add("textures", {{"source", builder.add_image(png(3, 2, 4, pixels))}});
  builder.json["materials"] = {
      {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
      {{"alphaMode", "MASK"},
       {"alphaCutoff", .25},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}},
      {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}},
      {{"alphaMode", "MASK"}}};
  const Scene scene = builder.import();
  ASSERT_EQ(scene.alpha_heap.size(), 4u + 6u);
  const shared::Material& masked = scene.materials[1];
  EXPECT_EQ(masked.flags, shared::material_alpha_mask);
  EXPECT_FLOAT_EQ(masked.alpha_cutoff, 0.25f);
  EXPECT_EQ(masked.alpha_mask, 4u);
  EXPECT_EQ(masked.alpha_mask_size, 3u | 2u << 16);
  EXPECT_EQ(masked.alpha_mask_wrap, shared::wrap_repeat | shared::wrap_repeat << 8);
  EXPECT_EQ(scene.materials[0].alpha_mask_wrap, shared::wrap_clamp | shared::wrap_repeat << 8);
  EXPECT_EQ(scene.alpha_heap[4], 10);
  EXPECT_EQ(scene.alpha_heap[9], 60);
  EXPECT_EQ(scene.materials[2].alpha_mask, 4u) << "the same image must be stored once";
  EXPECT_EQ(scene.materials[3].alpha_mask, shared::no_texture);
}

TEST(Materials, SamplersFollowGltfCodes) {
  GltfBuilder builder = everything();
  builder.json["samplers"][0] = {
      {"magFilter", 9728}, {"minFilter", 9986}, {"wrapS", 33648}, {"wrapT", 33071}};
  Sampler sampler = builder.import().textures[0].sampler;
  EXPECT_EQ(sampler.magnify, Filter::nearest);
  EXPECT_EQ(sampler.minify, Filter::nearest);
  EXPECT_TRUE(sampler.mipmapped);
  EXPECT_EQ(sampler.mip_filter, Filter::linear);
  EXPECT_EQ(sampler.wrap_s, shared::wrap_mirror);
  EXPECT_EQ(sampler.wrap_t, shared::wrap_clamp);
  builder.json["samplers"][0]["minFilter"] = 9729;
  sampler = builder.import().textures[0].sampler;
  EXPECT_EQ(sampler.minify, Filter::linear);
  EXPECT_FALSE(sampler.mipmapped);
}

}  // namespace
}  // namespace heliograph::scene::test
