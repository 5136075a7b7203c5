#include <gtest/gtest.h>

#include <cstring>
#include <sstream>
#include <stop_token>

#include "tests/unit/scene/support/encoders.hpp"
#include "tests/unit/scene/support/exported_scene.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

void expect_same_geometry(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  EXPECT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_EQ(a.meshes[i].indices, b.meshes[i].indices);
    ASSERT_EQ(a.meshes[i].vertices.size(), b.meshes[i].vertices.size());
    EXPECT_EQ(0, std::memcmp(a.meshes[i].vertices.data(), b.meshes[i].vertices.data(),
                             a.meshes[i].vertices.size() * sizeof(shared::Vertex)));
  }
}

void expect_same_images(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    ASSERT_TRUE(a.images[i].file && b.images[i].file);
    EXPECT_EQ(*a.images[i].file, *b.images[i].file);
  }
}

TEST(GlbExport, WithoutChangesTheSceneIsTheSame) {
  Exported exported(everything());
  exported.write();
  expect_same_geometry(exported.before, exported.after);
  expect_same_images(exported.before, exported.after);
  ASSERT_EQ(exported.before.materials.size(), exported.after.materials.size());
  EXPECT_EQ(0, std::memcmp(exported.before.materials.data(), exported.after.materials.data(),
                           exported.before.materials.size() * sizeof(shared::Material)));
  EXPECT_EQ(exported.before.lights.size(), exported.after.lights.size());
  EXPECT_EQ(exported.before.cameras.size(), exported.after.cameras.size());
  EXPECT_EQ(exported.before.clips.size(), exported.after.clips.size());
  EXPECT_EQ(exported.before.skins.size(), exported.after.skins.size());
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, BuffersAndImagesBesideTheFileBecomePartOfIt) {
  GltfBuilder builder = everything();
  const Bytes image = png(2, 2, 4, Bytes(16, 99));
  builder.json["buffers"][0]["uri"] = "data%20of.bin";
  builder.json["images"][0] = {{"uri", "colour.png"}, {"name", "paint"}};
  const std::string text = builder.json.dump();
  Exported exported({text.begin(), text.end()}, "scene.gltf", {},
                    {{"data of.bin", builder.binary}, {"colour.png", image}});
  exported.write();
  expect_same_geometry(exported.before, exported.after);
  expect_same_images(exported.before, exported.after);
  EXPECT_EQ(*exported.after.images.at(0).file, image);
  const json document = exported.document();
  EXPECT_EQ(document.at("images")[0].at("mimeType"), "image/png");
  EXPECT_EQ(document.at("images")[0].at("name"), "paint");
  EXPECT_EQ(document.at("buffers").size(), 1u);
  EXPECT_EQ(exported.after.sources.size(), 1u);
}

TEST(GlbExport, DataUrisAndSeveralBuffersAreJoined) {
  GltfBuilder builder = triangle();
  const Bytes more = {1, 0, 0, 0, 0, 0, 0, 0, 1};
  builder.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + base64(builder.binary);
  builder.add("buffers",
              {{"byteLength", 9}, {"uri", "data:application/octet-stream;base64," + base64(more)}});
  builder.add("buffers", {{"byteLength", 1}, {"uri", "nothing_uses_it.bin"}});
  builder.add("bufferViews", {{"buffer", 1}, {"byteOffset", 3}, {"byteLength", 6}});
  builder.json["accessors"].push_back(
      {{"bufferView", 1}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", 3}});
  builder.json["meshes"][0]["primitives"][0]["indices"] = 1;
  builder.json["accessors"][1]["byteOffset"] = 0;
  builder.binary.clear();
  const std::string text = builder.json.dump();
  Exported exported({text.begin(), text.end()}, "scene.gltf");
  exported.write();
  const json views = exported.document().at("bufferViews");
  EXPECT_EQ(views[1].at("buffer"), 0);
  const auto offset = views[1].at("byteOffset").get<std::size_t>();
  EXPECT_EQ(offset % 4, 3u) << "alignment within the buffer stays";
  expect_same_geometry(exported.before, exported.after);
}

TEST(GlbExport, CompressedViewsStayCompressed) {
  GltfBuilder builder = triangle();
  const Scene plain = builder.import();
  const Bytes packed = pack_vertices(builder.binary, 12);
  const json compression = {{"buffer", 0},
                            {"byteLength", packed.size()},
                            {"byteStride", 12},
                            {"count", 3},
                            {"mode", "ATTRIBUTES"}};
  builder.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  builder.json["bufferViews"][0] = {{"buffer", 1},
                                    {"byteLength", 36},
                                    {"byteStride", 12},
                                    {"extensions", {{"EXT_meshopt_compression", compression}}}};
  builder.json["buffers"] = {
      {{"byteLength", packed.size()}},
      {{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  builder.binary = packed;
  Exported exported(builder);
  exported.write();
  expect_same_geometry(plain, exported.after);
  EXPECT_EQ(exported.document().at("bufferViews"), builder.json["bufferViews"]);
  EXPECT_EQ(exported.document().at("buffers"), builder.json["buffers"]);
}

TEST(GlbExport, ImagesWithoutTypeGetThatOfTheirBytes) {
  GltfBuilder builder = triangle();
  const auto add = [&](std::string file) {
    builder.add("images", {{"uri", "data:;base64," + base64({file.begin(), file.end()})}});
  };
  add(std::string("RIFF\0\0\0\0WEBPVP8 ", 16));
  add("\xabKTX 20\xbb\r\n\x1a\n");
  add("\xff\xd8\xff\xe0");
  Exported exported(builder);
  exported.write();
  const json images = exported.document().at("images");
  EXPECT_EQ(images[0].at("mimeType"), "image/webp");
  EXPECT_EQ(images[1].at("mimeType"), "image/ktx2");
  EXPECT_EQ(images[2].at("mimeType"), "image/jpeg");
}

TEST(GlbExport, WhatTheImporterDoesNotReadStays) {
  GltfBuilder builder = everything();
  builder.json["asset"]["copyright"] = "the author";
  builder.json["extensionsUsed"].push_back("VENDOR_notes");
  builder.json["extensions"]["VENDOR_notes"] = {{"id", 1234567890123}, {"none", nullptr}};
  builder.json["nodes"][1]["extras"] = {{"id", 1234567890123}};
  builder.json["bufferViews"][0]["extensions"] = {{"VENDOR_notes", {{"stored", true}}}};
  builder.json["skins"][0]["extras"] = "a skin";
  Exported exported(builder);
  exported.write();
  const json document = exported.document();
  for (const char* const member : {"asset", "nodes", "skins", "animations", "extensions", "cameras",
                                   "meshes", "accessors", "textures", "samplers"}) {
    EXPECT_EQ(document.at(member), builder.json.at(member)) << member;
  }
  EXPECT_EQ(document.at("bufferViews")[0].at("extensions"),
            builder.json["bufferViews"][0]["extensions"]);
}

TEST(GlbExport, TheShownVariantAndSceneAreThoseOfTheFile) {
  GltfBuilder builder = everything();
  builder.add("materials", {{"name", "red"}, {"doubleSided", true}});
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
      {"mappings", {{{"material", 1}, {"variants", {0}}}}}};
  builder.add("scenes", {{"name", "other"}, {"nodes", {0}}});
  Exported exported(builder, {.scene = "other", .variant = "red"});
  exported.write();
  EXPECT_EQ(exported.after.meshes.at(0).material, 1u);
  EXPECT_EQ(exported.after.shown_scene, 1u);
}

TEST(GlbExport, HiddenNodesAreHiddenUnlessTheyHoldLights) {
  GltfBuilder builder = everything();  // node 2, below node 0, has the light
  const auto mesh = builder.json["nodes"][0]["mesh"];
  builder.add("nodes", {{"name", "part"}, {"mesh", mesh}});
  builder.json["nodes"][0]["children"].push_back(3);
  Exported exported(builder);
  ASSERT_EQ(exported.before.instances.size(), 2u);
  exported.changes.hidden = {0};
  exported.write();
  EXPECT_EQ(exported.after.instances.size(), 1u) << "the part is hidden";
  EXPECT_EQ(exported.after.lights.size(), 1u);
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("is visible in the file"), std::string::npos);

  Exported part(builder);
  part.changes.hidden = {3};
  part.write();
  EXPECT_EQ(part.after.instances.size(), 1u);
  EXPECT_TRUE(part.warnings.empty());
}

TEST(GlbExport, MissingImagesStayMissing) {
  GltfBuilder builder = everything();
  builder.json["images"][0] = {{"uri", "nowhere.png"}};
  Exported exported(builder);
  std::ostringstream out;
  exported.warnings = export_glb(exported.before, {}, {}, out);
  exported.file = out.str();
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("images[0]"), std::string::npos);
  EXPECT_EQ(exported.document().at("images")[0].at("uri"), "nowhere.png");
}

std::string export_refusal(const Exported& exported, const ImportLimits& limits = {}) {
  std::ostringstream out;
  try {
    export_glb(exported.before, exported.changes, limits, out);
  } catch (const ImportError& error) {
    EXPECT_TRUE(out.str().empty());
    return error.what();
  }
  return "";
}

TEST(GlbExport, RefusesFilesThatChangedSinceTheSceneWasLoaded) {
  Exported exported(everything());
  exported.folder.write("scene.glb", triangle().glb());
  EXPECT_NE(export_refusal(exported).find("changed"), std::string::npos);
  std::filesystem::remove(exported.folder.path() / "scene.glb");
  EXPECT_NE(export_refusal(exported).find("changed"), std::string::npos);
}

TEST(GlbExport, LimitOnFilesHolds) {
  GltfBuilder builder = triangle();
  builder.binary.resize(100000);
  builder.json["buffers"][0]["byteLength"] = 100000;
  Exported exported(builder);
  EXPECT_NE(export_refusal(exported, {.file_bytes = 50000}).find("limit"), std::string::npos);
  EXPECT_EQ(export_refusal(exported, {.file_bytes = 200000}), "");
}

TEST(GlbExport, SceneThatIsNoFileIsRefused) {
  std::ostringstream out;
  EXPECT_THROW(export_glb(Scene(), {}, {}, out), ImportError);
}

TEST(GlbExport, CanBeCancelled) {
  const Exported exported(everything());
  std::stop_source stop;
  stop.request_stop();
  std::ostringstream out;
  EXPECT_THROW(export_glb(exported.before, {}, {}, out, stop.get_token()), LoadCancelled);
}

}  // namespace
}  // namespace heliograph::scene::test
