#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scene/gltf/export/glb_export.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "scene/import.hpp"
#include "tests/unit/scene/support/encoders.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

/// A triangle whose material "paint" has a base color from a 2 x 1 image with a sampler, and the
/// same image as its emission.
GltfBuilder painted() {
  GltfBuilder builder = triangle();
  builder.add("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
  const std::uint32_t image = builder.add_image(png(2, 1, 3, {255, 0, 0, 255, 0, 0}));
  builder.json["images"][image]["name"] = "planks";
  builder.add("textures", {{"source", image}, {"sampler", 0}});
  builder.add("textures", {{"source", image}});
  builder.add("materials",
              {{"name", "paint"},
               {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}},
               {"emissiveTexture", {{"index", 1}}}});
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  return builder;
}

/// The scene in a folder with images to put in the place of its textures.
class Overridden {
 public:
  explicit Overridden(const GltfBuilder& builder = painted())
      : file_(folder_.write("scene.glb", builder.glb())) {}

  TextureOverride with(std::string slot, std::string name, const Bytes& bytes,
                       std::string material = "paint") {
    const auto image = folder_.write(name, bytes);
    return {std::move(material), std::move(slot), std::move(name), image};
  }
  static TextureOverride without(std::string slot) { return {"paint", std::move(slot), {}, {}}; }
  Scene import(std::vector<TextureOverride> textures) const {
    return import_gltf(file_, strict_limits, {.textures = std::move(textures)});
  }
  Scene import_leniently(std::vector<TextureOverride> textures) const {
    return import_gltf(file_, {}, {.textures = std::move(textures)});
  }
  /// The export of the scene, imported where there is no other file.
  Scene exported(const Scene& scene) {
    std::ostringstream out;
    warnings = export_glb(scene, {}, {}, out);
    text = std::move(out).str();
    const TemporaryFolder alone;
    return import_gltf(alone.write("exported.glb", text), strict_limits);
  }
  json document() const {
    std::uint32_t length = 0;
    std::memcpy(&length, text.data() + 12, sizeof length);
    return json::parse(text.substr(20, length));
  }

  std::vector<std::string> warnings;
  std::string text;

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
};

const Image& image_of(const Scene& scene, const shared::TextureSlot& slot) {
  return scene.images.at(scene.textures.at(slot.texture).image);
}

const Bytes green = png(1, 3, 3, {0, 255, 0, 0, 255, 0, 0, 255, 0});

TEST(TextureOverrides, AnImageTakesThePlaceOfATextureWithItsSampler) {
  Overridden overridden;
  const Scene scene = overridden.import({overridden.with("base_color", "moss.png", green)});
  const shared::TextureSlot& slot = scene.materials[0].base_color_texture;
  const Image& image = image_of(scene, slot);
  EXPECT_EQ(image.height, 3u);
  EXPECT_TRUE(image.srgb);
  EXPECT_EQ(*image.file, green);
  EXPECT_EQ(slot.uv_set, 1u);
  EXPECT_EQ(scene.textures[slot.texture].sampler.wrap_s, shared::wrap_clamp);
  EXPECT_EQ(scene.textures[slot.texture].sampler.magnify, Filter::nearest);
  ASSERT_EQ(scene.replaced_textures.size(), 1u);
  EXPECT_EQ(scene.replaced_textures[0].file_image, "planks");
  EXPECT_EQ(scene.replaced_textures[0].file_width, 2u);
  EXPECT_EQ(image_of(scene, scene.materials[0].emissive_texture).name, "planks");
  EXPECT_EQ(scene.sources.size(), 2u) << "a changed image is seen";
}

TEST(TextureOverrides, ASlotWithoutTextureGetsOneAsDataOrColors) {
  Overridden overridden;
  const Scene scene = overridden.import({overridden.with("normal", "bumps.png", green),
                                         overridden.with("sheen_color", "silk.png", green)});
  EXPECT_FALSE(image_of(scene, scene.materials[0].normal_texture).srgb);
  EXPECT_TRUE(image_of(scene, scene.material_layers[0].sheen_color_texture).srgb);
  EXPECT_FALSE(scene.replaced_textures[0].file_image);
  EXPECT_EQ(scene.textures[scene.materials[0].normal_texture.texture].sampler, Sampler());
}

TEST(TextureOverrides, WhatNoSlotUsesIsNotDecoded) {
  const Scene scene =
      Overridden().import({Overridden::without("base_color"), Overridden::without("emissive")});
  EXPECT_EQ(scene.materials[0].base_color_texture.texture, shared::no_texture);
  EXPECT_TRUE(scene.images.empty());
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_EQ(scene.replaced_textures[1].file_width, 2u);
}

TEST(TextureOverrides, WithoutOverridesTheSceneIsAsTheFile) {
  const Scene scene = Overridden().import({});
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_TRUE(scene.replaced_textures.empty());
}

TEST(TextureOverrides, UnknownMaterialsAndSlotsAreNamed) {
  Overridden overridden;
  try {
    overridden.import({overridden.with("base_color", "moss.png", green, "pant")});
    FAIL() << "there is no such material";
  } catch (const NoSuchSlot& refusal) {
    EXPECT_EQ(refusal.member(), "material");
    EXPECT_EQ(refusal.names(), std::vector<std::string>{"paint"});
  }
  EXPECT_THROW(overridden.import({Overridden::without("colour")}), NoSuchSlot);
}

TEST(TextureOverrides, AFileThatIsNoImageRefusesTheScene) {
  Overridden overridden;
  EXPECT_THROW(overridden.import({overridden.with("normal", "text.png", Bytes(40, 'x'))}),
               ImportError);
  EXPECT_THROW(overridden.import({{"paint", "normal", "gone", "/nowhere/gone.png"}}), ImportError);
}

TEST(TextureOverrides, ADamagedImageRefusesTheSceneThoughThoseOfTheFileMayBeDamaged) {
  Overridden overridden;
  const Bytes cut(green.begin(), green.end() - 20);
  const TextureOverride damaged = overridden.with("emissive", "moss.png", cut);
  try {
    overridden.import_leniently({damaged});
    FAIL() << "the image is shown as one texel";
  } catch (const ImportError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("\"moss.png\" is a damaged PNG"), std::string::npos)
        << refusal.what();
  }
}

TEST(TextureOverrides, ADamagedImageOfTheFileIsKnownAsSuch) {
  GltfBuilder builder = painted();
  const std::uint32_t damaged = builder.add_image(Bytes(green.begin(), green.end() - 20));
  builder.json["textures"][1]["source"] = damaged;
  const Scene scene = Overridden(builder).import_leniently({});
  EXPECT_TRUE(image_of(scene, scene.materials[0].emissive_texture).damaged);
  EXPECT_FALSE(image_of(scene, scene.materials[0].base_color_texture).damaged);
}

TEST(TextureOverrides, NamesOfSlotsAreUnique) {
  std::set<std::string_view> names;
  std::set<std::string> places;
  for (const TextureKind& kind : texture_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(places.insert(std::string(kind.owner) + "." + kind.member).second) << kind.name;
    EXPECT_EQ(find_texture_kind(kind.name), &kind);
    EXPECT_NE(kind.base == nullptr, kind.layer == nullptr) << kind.name;
  }
  EXPECT_EQ(find_texture_kind("colour"), nullptr);
}

TEST(TextureExport, ReplacedImagesAreEmbeddedAsTheyAre) {
  Overridden overridden;
  const Bytes silk = webp(1, 1, {9, 9, 9, 255});
  const Scene before = overridden.import({overridden.with("base_color", "moss.png", green),
                                          overridden.with("sheen_color", "silk.webp", silk),
                                          Overridden::without("emissive")});
  const Scene after = overridden.exported(before);
  EXPECT_TRUE(overridden.warnings.empty());
  const shared::TextureSlot& slot = after.materials[0].base_color_texture;
  EXPECT_EQ(*image_of(after, slot).file, green);
  EXPECT_EQ(slot.uv_set, 1u);
  EXPECT_EQ(after.textures[slot.texture].sampler.wrap_s, shared::wrap_clamp);
  EXPECT_EQ(*image_of(after, after.material_layers[0].sheen_color_texture).file, silk);
  EXPECT_EQ(after.materials[0].emissive_texture.texture, shared::no_texture);
  const json document = overridden.document();
  EXPECT_EQ(document["images"].back()["mimeType"], "image/webp");
  EXPECT_NE(document["extensionsUsed"].dump().find("EXT_texture_webp"), std::string::npos);
  EXPECT_EQ(document["extensionsRequired"], json::array({"EXT_texture_webp"}))
      << "its texture has no other source";
  EXPECT_NE(document["extensionsUsed"].dump().find("KHR_materials_sheen"), std::string::npos);
}

TEST(TextureExport, AnImageOfTwoSlotsIsEmbeddedOnce) {
  Overridden overridden;
  TextureOverride first = overridden.with("base_color", "moss.png", green);
  TextureOverride second = first;
  second.slot = "occlusion";
  overridden.exported(overridden.import({first, second}));
  EXPECT_EQ(overridden.document()["images"].size(), 2u);
  EXPECT_FALSE(overridden.document().contains("extensionsRequired")) << "PNG needs none";
}

TEST(TextureExport, MaterialsOfPrimitivesWithoutOneAreAdded) {
  Overridden overridden(triangle());
  const Scene after = overridden.exported(
      overridden.import({overridden.with("base_color", "moss.png", green, "default")}));
  EXPECT_EQ(*image_of(after, after.materials[0].base_color_texture).file, green);
}

}  // namespace
}  // namespace heliograph::scene::test
