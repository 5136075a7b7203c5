// Of the binary chunk of a .glb, files of images are read apart from all else.
#include <gtest/gtest.h>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

/// A triangle with a texture of 32 x 32 texels of noise, in the last view.
GltfBuilder textured() {
  GltfBuilder builder = triangle();
  Bytes samples(32 * 32 * 4);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint8_t>(i * i);
  builder.add("textures", {{"source", builder.add_image(png(32, 32, 4, samples))}});
  builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  return builder;
}

/// Adds a material whose texture is the file in `view`, too.
void add_material_with(GltfBuilder& builder, std::uint32_t view) {
  const auto image = builder.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  const auto texture = builder.add("textures", {{"source", image}});
  builder.add("materials",
              {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
}

TEST(BinaryChunk, FilesOfImagesAreHeldOnce) {
  GltfBuilder builder = textured();
  add_material_with(builder, builder.json["images"][0]["bufferView"]);
  const Scene scene = builder.import();
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[0].file, scene.images[1].file);
  EXPECT_EQ(scene.images[0].pixels, scene.images[1].pixels);
}

TEST(BinaryChunk, ViewsMayHoldImagesAndNumbers) {
  GltfBuilder builder = textured();
  const Image expected = builder.import().images.at(0);
  const std::uint32_t view = builder.json["images"][0]["bufferView"];
  const auto colors = builder.add_accessor(view, 5121, "VEC4", 3, true);
  builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
  const Scene scene = builder.import();
  EXPECT_EQ(scene.images.at(0).pixels, expected.pixels);
  // A PNG begins with 89 50 4e 47.
  EXPECT_EQ(scene.meshes.at(0).vertices.at(0).color_rg, 0x50508989u);
}

TEST(BinaryChunk, ViewsOfImagesMayNotOverlapWithoutLimit) {
  GltfBuilder builder = textured();
  const std::uint32_t view = builder.json["images"][0]["bufferView"];
  for (int i = 0; i < 20; ++i) {
    add_material_with(builder, builder.add("bufferViews", builder.json["bufferViews"][view]));
  }
  EXPECT_EQ(refusal_of(builder), "");
  ImportLimits limits;
  limits.file_bytes = builder.glb().size();
  EXPECT_NE(refusal_of(builder, limits).find("of the limit on files"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::scene::test
