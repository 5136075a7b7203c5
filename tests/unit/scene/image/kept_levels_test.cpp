// Large levels of textures need not be kept where nothing reads them.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/gltf/materials/images.hpp"
#include "scene/image/mipmaps.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

/// A triangle with a texture of 16 x 8 texels, none like the next.
GltfBuilder textured() {
  GltfBuilder builder = triangle();
  Bytes samples(16 * 8 * 4);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint8_t>(i * 7);
  builder.add("textures", {{"source", builder.add_image(png(16, 8, 4, samples))}});
  builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  return builder;
}

Scene import_with(const GltfBuilder& builder, const KeptTextures& kept) {
  const TemporaryFolder folder;
  return import_gltf(folder.write("scene.glb", builder.glb()), {}, {.kept_textures = kept});
}

TEST(KeptLevels, AreTheLastOfAllLevels) {
  const Image whole = textured().import().images.at(0);
  ASSERT_EQ(whole.pixels.size(), mip_chain_bytes(16, 8));
  const Image kept = import_with(textured(), {.longest_side = 4}).images.at(0);
  EXPECT_EQ(kept.width, 16u);
  EXPECT_EQ(kept.levels, 5u);
  ASSERT_EQ(kept.pixels.size(), mip_chain_bytes(4, 2));
  EXPECT_EQ(first_level_in(kept, kept.pixels.size()), 2u);
  EXPECT_TRUE(std::equal(kept.pixels.rbegin(), kept.pixels.rend(), whole.pixels.rbegin()));
}

TEST(KeptLevels, AreDecodedAgainWhereMoreAreNeeded) {
  const Image whole = textured().import().images.at(0);
  const Image kept = import_with(textured(), {.longest_side = 4}).images.at(0);
  EXPECT_EQ(ImagePixels(kept, 2).get().data(), kept.pixels.data());
  EXPECT_EQ(ImagePixels(kept, 3).get().data(), kept.pixels.data());
  EXPECT_TRUE(std::ranges::equal(ImagePixels(kept, 0).get(), whole.pixels));
  EXPECT_TRUE(std::ranges::equal(ImagePixels(kept, 1).get(), whole.pixels));
}

TEST(KeptLevels, HaveNoMoreTexelsThanFit) {
  const Scene scene = textured().import();
  EXPECT_EQ(longest_side_that_fits(scene.images, {}), largest_image_side);
  EXPECT_EQ(longest_side_that_fits(scene.images, {8, 43}), 8u) << "8 x 4, 4 x 2, 2 x 1 and 1";
  EXPECT_EQ(longest_side_that_fits(scene.images, {8, 42}), 4u);
  EXPECT_EQ(longest_side_that_fits(scene.images, {8, 2}), std::nullopt);
  const KeptTextures few{.longest_side = 8, .most_texels = 42};
  EXPECT_EQ(import_with(textured(), few).images.at(0).pixels.size(), mip_chain_bytes(4, 2));
}

TEST(KeptLevels, LeaveAlphaMasksWhole) {
  GltfBuilder masked = textured();
  masked.json["materials"][0]["alphaMode"] = "MASK";
  const Scene whole = masked.import();
  const Scene kept = import_with(masked, {.longest_side = 1});
  ASSERT_EQ(whole.alpha_heap.size(), 128u);
  EXPECT_EQ(kept.alpha_heap, whole.alpha_heap);
  EXPECT_EQ(kept.images.at(0).pixels.size(), 4u);
}

}  // namespace
}  // namespace heliograph::scene::test
