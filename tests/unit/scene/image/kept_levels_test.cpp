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

Scene import_with(const GltfBuilder& builder, std::uint32_t longest_kept_side) {
  const TemporaryFolder folder;
  return import_gltf(folder.write("scene.glb", builder.glb()), {},
                     {.longest_kept_side = longest_kept_side});
}

TEST(KeptLevels, AreTheLastOfAllLevels) {
  const Image whole = textured().import().images.at(0);
  ASSERT_EQ(whole.pixels.size(), mip_chain_bytes(16, 8));
  const Image kept = import_with(textured(), 4).images.at(0);
  EXPECT_EQ(kept.width, 16u);
  EXPECT_EQ(kept.levels, 5u);
  ASSERT_EQ(kept.pixels.size(), mip_chain_bytes(4, 2));
  EXPECT_EQ(first_level_in(kept, kept.pixels.size()), 2u);
  EXPECT_TRUE(std::equal(kept.pixels.rbegin(), kept.pixels.rend(), whole.pixels.rbegin()));
}

TEST(KeptLevels, AreDecodedAgainWhereMoreAreNeeded) {
  const Image whole = textured().import().images.at(0);
  const Image kept = import_with(textured(), 4).images.at(0);
  EXPECT_EQ(ImagePixels(kept, 2).get().data(), kept.pixels.data());
  EXPECT_EQ(ImagePixels(kept, 3).get().data(), kept.pixels.data());
  EXPECT_TRUE(std::ranges::equal(ImagePixels(kept, 0).get(), whole.pixels));
  EXPECT_TRUE(std::ranges::equal(ImagePixels(kept, 1).get(), whole.pixels));
}

TEST(KeptLevels, LeaveAlphaMasksWhole) {
  GltfBuilder masked = textured();
  masked.json["materials"][0]["alphaMode"] = "MASK";
  const Scene whole = masked.import();
  const Scene kept = import_with(masked, 1);
  ASSERT_EQ(whole.alpha_heap.size(), 128u);
  EXPECT_EQ(kept.alpha_heap, whole.alpha_heap);
  EXPECT_EQ(kept.images.at(0).pixels.size(), 4u);
}

}  // namespace
}  // namespace heliograph::scene::test
