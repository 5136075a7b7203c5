#include "session/edits/texture_edits.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "scene/gltf/materials/materials.hpp"
#include "session/session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace heliograph::session {
namespace {

using protocol::TextureEdit;

scene::ReplacedTexture replaced(std::uint32_t material, scene::TextureOverride by) {
  return {.material = material, .by = std::move(by), .file_image = {}};
}

/// Two materials: "floor" has a base color of 4 x 2 pixels in the file, "wall" has nothing.
std::shared_ptr<scene::Scene> a_room(std::vector<scene::ReplacedTexture> textures = {}) {
  auto scene = std::make_shared<scene::Scene>();
  scene->materials.assign(2, scene::default_material());
  scene->material_layers.resize(2);
  scene->material_names = {"floor", "wall"};
  scene->images.push_back({.name = "planks", .width = 4, .height = 2});
  scene->textures.push_back({.image = 0, .sampler = {}});
  scene->materials[0].base_color_texture.texture = 0;
  scene->bounds.include(glm::vec3(-1.0f));
  scene->bounds.include(glm::vec3(1.0f));
  scene->replaced_textures = std::move(textures);
  return scene;
}

/// A folder with the images bricks.png and moss.webp.
class ImageCatalogue {
 public:
  ImageCatalogue() {
    for (const char* name : {"bricks.png", "moss.webp", "note.txt"}) {
      std::ofstream(folder_.path() / name) << name;
    }
  }
  SceneCatalogue get() const { return SceneCatalogue({folder_.path()}); }

 private:
  heliograph::test::TemporaryFolder folder_;
};

TEST(TextureEdits, TexturesOfTheFileAreListedWithTheirSize) {
  const protocol::TextureList list = list_textures(*a_room());
  EXPECT_EQ(list.slots.front(), "base_color");
  ASSERT_EQ(list.textures.size(), 1u);
  EXPECT_EQ(list.textures[0].material, "floor");
  EXPECT_EQ(list.textures[0].file_image, "planks");
  EXPECT_EQ(list.textures[0].width, 4u);
  EXPECT_FALSE(list.textures[0].image || list.textures[0].removed);
}

TEST(TextureEdits, ADamagedImageOfTheFileHasNoSize) {
  const auto room = a_room();
  room->images[0].damaged = true;
  const protocol::TextureList list = list_textures(*room);
  ASSERT_EQ(list.textures.size(), 1u);
  EXPECT_EQ(list.textures[0].file_image, "planks");
  EXPECT_EQ(list.textures[0].width, 0u);
  EXPECT_EQ(list.textures[0].height, 0u);
}

TEST(TextureEdits, ReplacedAndRemovedOnesAreListedWithThoseOfTheFile) {
  auto floor = replaced(0, {"floor", "base_color", "", ""});
  floor.file_image = "planks";
  floor.file_width = 4;
  const auto room = a_room({floor, replaced(1, {"wall", "normal", "bricks", "/bricks.png"})});
  const protocol::TextureList list = list_textures(*room);
  ASSERT_EQ(list.textures.size(), 2u);
  EXPECT_TRUE(list.textures[0].removed);
  EXPECT_EQ(list.textures[0].width, 4u);
  EXPECT_EQ(list.textures[1].image, "bricks");
  EXPECT_FALSE(list.textures[1].file_image);
  protocol::EditDocument document;
  describe_textures(*room, document);
  EXPECT_EQ(document.textures,
            (std::vector<TextureEdit>{{"floor", "base_color", {}}, {"wall", "normal", "bricks"}}));
}

TEST(TextureEdits, AChangeReplacesTheOneOfItsSlotAndNullRestores) {
  const ImageCatalogue images;
  const protocol::TextureSet bricks{"floor", "normal", {.value = "bricks"}, false};
  auto textures = with_change({}, bricks, images.get());
  ASSERT_TRUE(textures);
  EXPECT_EQ(textures->at(0).image.filename(), "bricks.png");
  textures = with_change(*textures, {"floor", "base_color", {}, true}, images.get());
  ASSERT_TRUE(textures);
  ASSERT_EQ(textures->size(), 2u);
  EXPECT_EQ(textures->at(0).slot, "base_color") << "in one order, whatever came first";
  textures = with_change(*textures, {"floor", "normal", {.value = "moss"}, false}, images.get());
  EXPECT_EQ(textures->at(1).name, "moss");
  textures = with_change(*textures, {"floor", "normal", {.reset = true}, false}, images.get());
  EXPECT_EQ(textures->size(), 1u);
}

TEST(TextureEdits, RefusalsNameTheMember) {
  const ImageCatalogue images;
  const auto path = [](const auto& result) { return result ? "" : result.error().path; };
  EXPECT_EQ(path(with_change({}, {"floor", "normal", {.value = "brick"}, false}, images.get())),
            "image");
  EXPECT_EQ(path(with_change({}, {"floor", "normal", {.value = "note"}, false}, images.get())),
            "image");
  EXPECT_EQ(path(with_change({}, {"floor", "normal", {}, false}, images.get())), "image");
  EXPECT_EQ(path(with_change({}, {"floor", "normal", {.reset = true}, true}, images.get())),
            "image");
  EXPECT_EQ(path(check_slot(*a_room(), "flor", "normal")), "material");
  EXPECT_EQ(path(check_slot(*a_room(), "floor", "colour")), "slot");
  EXPECT_TRUE(check_slot(*a_room(), "floor", "clearcoat_normal"));
  protocol::EditDocument document;
  document.textures = {{"floor", "normal", "bricks"}, {"floor", "normal", {}}};
  EXPECT_EQ(path(overrides_of(document, images.get())), "edits.textures[1].slot");
  document.textures = {{"floor", "normal", "brick"}};
  EXPECT_EQ(path(overrides_of(document, images.get())), "edits.textures[0].image");
  document.textures = {{"roof", "normal", {}}};
  EXPECT_EQ(path(check_slots(*a_room(), document)), "edits.textures[0].material");
}

TEST(TextureEdits, ADocumentWithAMissingImageNamesTheEntryAndTheImage) {
  const ImageCatalogue images;
  protocol::EditDocument document;
  document.textures = {
      {"floor", "normal", "bricks"}, {"wall", "normal", {}}, {"wall", "base_color", "gone"}};
  const auto refused = overrides_of(document, images.get());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "edits.textures[2].image");
  EXPECT_NE(refused.error().message.find("\"gone\""), std::string::npos) << refused.error().message;
}

TEST(TextureEdits, WhatIsShownIsComparedByTheNamesOfItsImages) {
  const auto room = a_room({replaced(0, {"floor", "base_color", "", ""}),
                            replaced(1, {"wall", "normal", "gone", "/gone.png"})});
  protocol::EditDocument document;
  document.textures = {{"wall", "normal", "gone"}, {"floor", "base_color", {}}};
  EXPECT_TRUE(has_textures(*room, document)) << "in any order";
  EXPECT_FALSE(has_textures(*a_room(), document));
  for (const std::vector<TextureEdit>& others :
       {std::vector<TextureEdit>{},
        {{"wall", "normal", "gone"}},
        {{"wall", "normal", "other"}, {"floor", "base_color", {}}},
        {{"wall", "occlusion", "gone"}, {"floor", "base_color", {}}},
        {{"wall", "normal", "gone"}, {"floor", "base_color", "gone"}},
        {{"wall", "normal", "gone"}, {"wall", "normal", "gone"}}}) {
    document.textures = others;
    EXPECT_FALSE(has_textures(*room, document));
  }
  document.textures.clear();
  EXPECT_TRUE(has_textures(*a_room(), document));
}

TEST(TextureEdits, AnotherVariantKeepsCameraAndEdits) {
  SessionOptions options;
  options.width = 64;
  options.height = 32;
  Session session(options, std::make_shared<WakeEvent>());
  session.scene().show({.name = "room", .scene = a_room(), .resources = nullptr}, "");
  ASSERT_TRUE(session.camera().set({.eye = protocol::Vec3{7, 8, 9}}, ""));
  ASSERT_TRUE(session.scene().patch_material({"wall", {.roughness = {0.25f}}}, ""));
  const protocol::Section uncut{.planes = {}, .cap_color = {0.1f, 0.2f, 0.9f}};
  ASSERT_TRUE(session.scene().set_section(uncut, ""));
  const auto room = a_room({replaced(1, {"wall", "normal", "bricks", "/bricks.png"})});
  ASSERT_TRUE(session.scene().show_variant({.name = "room", .scene = room, .resources = nullptr},
                                           std::nullopt, ""));
  EXPECT_EQ(session.render_state().scene, room);
  EXPECT_EQ(session.render_state().camera.eye, glm::vec3(7, 8, 9));
  const auto edits = session.scene().edits();
  ASSERT_TRUE(edits);
  ASSERT_EQ(edits->edits.materials.size(), 1u);
  EXPECT_EQ(edits->edits.materials[0].patch.roughness.value, 0.25f);
  ASSERT_EQ(edits->edits.textures.size(), 1u);
  EXPECT_EQ(session.scene().section()->cap_color, uncut.cap_color) << "of planes to come";
  session.scene().show({.name = "room", .scene = a_room(), .resources = nullptr}, "");
  EXPECT_NE(session.render_state().camera.eye, glm::vec3(7, 8, 9)) << "scene.load resets it";
}

TEST(TextureEdits, AnotherFileIsNoVariant) {
  const auto with_file = [](std::uint64_t bytes) {
    auto room = std::make_shared<scene::Scene>(*a_room());
    room->sources = {{.path = "/room.glb", .bytes = bytes}};
    return room;
  };
  Session session({}, std::make_shared<WakeEvent>());
  const auto room = with_file(100);
  session.scene().show({.name = "room", .scene = room, .resources = nullptr}, "");
  const auto shown = session.scene().show_variant(
      {.name = "room", .scene = with_file(200), .resources = nullptr}, std::nullopt, "");
  ASSERT_FALSE(shown);
  EXPECT_EQ(shown.error().code, protocol::ErrorCode::conflict);
  EXPECT_EQ(session.render_state().scene, room);
  EXPECT_TRUE(session.scene().show_variant(
      {.name = "room", .scene = with_file(100), .resources = nullptr}, std::nullopt, ""));
}

TEST(TextureEdits, WithoutASceneThereIsNoVariant) {
  Session session({}, std::make_shared<WakeEvent>());
  EXPECT_FALSE(session.scene().show_variant(
      {.name = "room", .scene = a_room(), .resources = nullptr}, std::nullopt, ""));
}

}  // namespace
}  // namespace heliograph::session
