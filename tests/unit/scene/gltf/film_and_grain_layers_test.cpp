// The import of KHR_materials_iridescence and KHR_materials_anisotropy.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

/// The scene whose only material has these extensions, which its file requires.
Scene import_extended(const json& extensions) {
  GltfBuilder builder = everything();
  for (const auto& [name, values] : extensions.items()) {
    builder.json["extensionsUsed"].push_back(name);
    builder.json["extensionsRequired"].push_back(name);
  }
  builder.json["materials"][0] = {{"extensions", extensions}};
  return builder.import();
}

TEST(FilmAndGrainLayers, HaveTheFactorsOfTheFile) {
  const Scene scene = import_extended(
      {{"KHR_materials_iridescence",
        {{"iridescenceFactor", 0.5},
         {"iridescenceIor", 1.75},
         {"iridescenceThicknessMinimum", 250},
         {"iridescenceThicknessMaximum", 125}}},
       {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.25}, {"anisotropyRotation", 1.5}}}});
  EXPECT_TRUE(scene.warnings.empty());
  const shared::MaterialLayer layer = scene.layers.at(scene.materials.at(0).layer);
  EXPECT_EQ(layer.iridescence, 0.5f);
  EXPECT_EQ(layer.film_ior, 1.75f);
  EXPECT_EQ(layer.film_least, 250.0f);
  EXPECT_EQ(layer.film_thickness, 125.0f);
  EXPECT_EQ(layer.anisotropy, 0.25f);
  EXPECT_NEAR(layer.grain_x, std::cos(1.5f), 1e-6f);
  EXPECT_NEAR(layer.grain_y, std::sin(1.5f), 1e-6f);
}

TEST(FilmAndGrainLayers, GrainFollowsTextureCoordinates) {
  const json anisotropic = {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}};
  const Scene scene = import_extended(anisotropic);
  for (const shared::Vertex& vertex : scene.meshes.at(0).vertices) {
    EXPECT_LT(glm::distance(vertex.tangent, glm::vec4(1, 0, 0, 1)), 1e-6f);
  }
  // Turned by a quarter by its texture's transform, as a normal map would be.
  const json turned = {{"KHR_texture_transform", {{"rotation", 1.5707963}}}};
  json textured = anisotropic;
  textured["KHR_materials_anisotropy"]["anisotropyTexture"] = {{"index", 0},
                                                               {"extensions", turned}};
  const Scene other = import_extended(textured);
  EXPECT_NEAR(other.meshes.at(0).vertices[0].tangent.x, 0.0f, 1e-4f);
}

TEST(FilmAndGrainLayers, AreNotThereWhereTheyDoNothing) {
  const Scene scene = import_extended({{"KHR_materials_iridescence", {{"iridescenceIor", 2.0}}},
                                       {"KHR_materials_anisotropy", {{"anisotropyRotation", 1.0}}},
                                       {"KHR_materials_dispersion", {{"dispersion", 1.0}}}});
  EXPECT_EQ(scene.layers.size(), 1u);
  EXPECT_EQ(scene.material_layers.at(0).iridescence_thickness_maximum, 400.0f);
  EXPECT_EQ(scene.material_layers.at(0).dispersion, 1.0f);
}

}  // namespace
}  // namespace heliograph::scene::test
