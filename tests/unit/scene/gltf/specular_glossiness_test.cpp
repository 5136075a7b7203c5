#include "scene/gltf/materials/specular_glossiness.hpp"

#include <gtest/gtest.h>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

constexpr const char* extension = "KHR_materials_pbrSpecularGlossiness";

/// Diffuse albedo and reflectance at normal incidence of a metallic-roughness material.
struct Response {
  glm::vec3 diffuse;
  glm::vec3 reflectance;
};

Response response_of(const MetallicRoughness& material) {
  const glm::vec3 color(material.base_color);
  return {color * (1.0f - material.metallic), glm::mix(glm::vec3(0.04f), color, material.metallic)};
}

TEST(SpecularGlossiness, DielectricsKeepTheirDiffuseColor) {
  const glm::vec3 diffuse(0.6f, 0.3f, 0.1f);
  const MetallicRoughness to = to_metallic_roughness(
      {.diffuse = glm::vec4(diffuse, 0.5f), .specular = glm::vec3(0.04f), .glossiness = 0.7f});
  EXPECT_NEAR(to.metallic, 0.0f, 1e-4f);
  EXPECT_NEAR(to.roughness, 0.3f, 1e-6f);
  EXPECT_LT(glm::distance(glm::vec3(to.base_color), diffuse), 1e-3f);
  EXPECT_EQ(to.base_color.w, 0.5f);
}

TEST(SpecularGlossiness, MetalsKeepTheirSpecularColor) {
  const glm::vec3 gold(1.0f, 0.77f, 0.34f);
  const MetallicRoughness to =
      to_metallic_roughness({.diffuse = glm::vec4(0, 0, 0, 1), .specular = gold});
  EXPECT_NEAR(to.metallic, 1.0f, 1e-4f);
  EXPECT_LT(glm::distance(response_of(to).reflectance, gold), 1e-3f);
}

TEST(SpecularGlossiness, BetweenBothReflectanceAndDiffuseStayClose) {
  for (const float share : {0.1f, 0.3f, 0.5f, 0.9f}) {
    const glm::vec3 color(0.8f, 0.5f, 0.2f);
    const Response given = response_of({.base_color = glm::vec4(color, 1), .metallic = share});
    const float largest = given.reflectance.x;
    // The other model scales its diffuse colour by 1 - the largest specular component.
    const MetallicRoughness to =
        to_metallic_roughness({.diffuse = glm::vec4(given.diffuse * 0.96f / (1.0f - largest), 1),
                               .specular = given.reflectance});
    const Response got = response_of(to);
    EXPECT_LT(glm::distance(got.reflectance, given.reflectance), 0.12f) << share;
    EXPECT_LT(glm::distance(got.diffuse, given.diffuse), 0.12f) << share;
  }
}

TEST(SpecularGlossiness, FactorsReplaceTheCoreMaterial) {
  GltfBuilder builder = everything();
  builder.json["extensionsUsed"].push_back(extension);
  builder.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 1, 1}}}},
                                  {"extensions",
                                   {{extension,
                                     {{"diffuseFactor", {0.5, 0.5, 0.5, 1}},
                                      {"specularFactor", {0.04, 0.04, 0.04}},
                                      {"glossinessFactor", 0.25}}}}}};
  const Scene scene = builder.import();
  const shared::Material& material = scene.materials.at(0);
  EXPECT_NEAR(material.base_color.z, 0.5f, 1e-3f);
  EXPECT_NEAR(material.metallic, 0.0f, 1e-4f);
  EXPECT_NEAR(material.roughness, 0.75f, 1e-6f);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST(SpecularGlossiness, TexturesAreConvertedTexelByTexel) {
  GltfBuilder builder = everything();
  // A red dielectric beside a white metal, of glossiness 0.2 and 1.
  const auto diffuse = builder.add_image(png(2, 1, 4, {188, 0, 0, 255, 0, 0, 0, 128}));
  const auto specular = builder.add_image(png(2, 1, 4, {56, 56, 56, 51, 255, 255, 255, 255}));
  const auto first = builder.add("textures", {{"source", diffuse}});
  const auto second = builder.add("textures", {{"source", specular}});
  builder.json["materials"][0] = {{"extensions",
                                   {{extension,
                                     {{"diffuseTexture", {{"index", first}}},
                                      {"specularGlossinessTexture", {{"index", second}}}}}}}};
  const Scene scene = builder.import();
  const shared::Material& material = scene.materials.at(0);
  EXPECT_EQ(material.base_color, glm::vec4(1.0f));
  EXPECT_EQ(material.metallic, 1.0f);
  const Image& color =
      scene.images.at(scene.textures.at(material.base_color_texture.texture).image);
  const Image& other =
      scene.images.at(scene.textures.at(material.metallic_roughness_texture.texture).image);
  EXPECT_TRUE(color.srgb);
  EXPECT_FALSE(other.srgb);
  EXPECT_NEAR(color.pixels[0], 188, 3);
  EXPECT_NEAR(color.pixels[1], 0, 20);
  EXPECT_EQ(color.pixels[3], 255);
  EXPECT_NEAR(color.pixels[4], 255, 1);
  EXPECT_EQ(color.pixels[7], 128);
  EXPECT_EQ(other.pixels[1], 204) << "roughness";
  EXPECT_NEAR(other.pixels[2], 0, 8) << "metallic";
  EXPECT_EQ(other.pixels[5], 0);
  EXPECT_EQ(other.pixels[6], 255);
}

}  // namespace
}  // namespace heliograph::scene::test
