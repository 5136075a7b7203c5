#include <gtest/gtest.h>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// Three scenes of one node each, the second the default.
GltfBuilder three_scenes() {
  GltfBuilder builder;
  for (const char* name : {"near", "middle", "far"}) builder.add("nodes", {{"name", name}});
  builder.add("scenes", {{"name", "day"}, {"nodes", {0}}});
  builder.add("scenes", {{"name", "night"}, {"nodes", {1}}});
  builder.add("scenes", {{"nodes", {2}}});
  builder.json["scene"] = 1;
  return builder;
}

std::string shown_node(const GltfBuilder& builder, const std::string& scene) {
  return builder.import({}, {.scene = scene, .variant = ""}).nodes.at(0).name;
}

TEST(SceneChoice, AcceptsSceneNameOrIndex) {
  const GltfBuilder builder = three_scenes();
  EXPECT_EQ(shown_node(builder, ""), "middle");
  EXPECT_EQ(shown_node(builder, "day"), "near");
  EXPECT_EQ(shown_node(builder, "2"), "far");
  const Scene scene = builder.import({}, {.scene = "2", .variant = ""});
  EXPECT_EQ(scene.shown_scene, 2u);
  EXPECT_EQ(scene.scenes, (std::vector<std::string>{"day", "night", ""}));
}

TEST(SceneChoice, NameTakesPrecedenceOverIndex) {
  GltfBuilder builder = three_scenes();
  builder.json["scenes"][0]["name"] = "2";
  EXPECT_EQ(shown_node(builder, "2"), "near");
}

TEST(SceneChoice, ErrorListsAvailableScenes) {
  for (const char* requested : {"dusk", "3", "-1", "1x", "99999999999999999999"}) {
    try {
      three_scenes().import({}, {.scene = requested, .variant = ""});
      FAIL() << requested;
    } catch (const NoSuchChoice& failure) {
      EXPECT_EQ(failure.member(), "scene");
      EXPECT_EQ(failure.names().size(), 3u);
    }
  }
}

TEST(SceneSources, ListEveryFileRead) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = test::triangle();
  builder.json["buffers"] = {{{"uri", "data.bin"}, {"byteLength", builder.binary.size()}}};
  folder.write("data.bin", builder.binary);
  const auto path = folder.write("scene.gltf", builder.json.dump());
  const Scene scene = import_gltf(path);
  ASSERT_EQ(scene.sources.size(), 2u);
  EXPECT_EQ(scene.sources[0], examine_file(path));
  EXPECT_EQ(scene.sources[1].path.filename(), "data.bin");
  EXPECT_EQ(scene.sources[1].bytes, builder.binary.size());
  EXPECT_GT(scene.sources[1].modified, 0);
}

}  // namespace
}  // namespace heliograph::scene
