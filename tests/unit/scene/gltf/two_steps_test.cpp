// A scene that is given away without its textures before its images are decoded.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "scene/gltf/materials/texture_kinds.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

/// Whether two lists of plain values have the same bytes.
template <class List>
bool same_bytes(const List& a, const List& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(&a[0], &b[0], a.size() * sizeof(a[0])) == 0);
}

/// everything(), with a mask of alpha, and with emission and metalness in textures.
GltfBuilder masked_scene() {
  GltfBuilder builder = everything();
  nlohmann::json& material = builder.json["materials"][0];
  material["alphaMode"] = "MASK";
  material["emissiveFactor"] = {1, 1, 1};
  material["emissiveTexture"]["index"] = 0;
  material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 0;
  return builder;
}

struct Steps {
  std::unique_ptr<Scene> first;
  std::uint64_t image_bytes = 0;
  std::optional<Scene> whole;
};

Steps import_in_steps(const std::filesystem::path& path, const ImportLimits& limits = {},
                      std::uint64_t from = 0) {
  Steps steps;
  ImportOptions options;
  options.untextured = [&](std::unique_ptr<Scene> scene, std::uint64_t image_bytes) {
    EXPECT_FALSE(steps.first) << "once";
    steps.first = std::move(scene);
    steps.image_bytes = image_bytes;
  };
  options.untextured_from = from;
  steps.whole = import_gltf(path, limits, options);
  return steps;
}

void expect_images_of_one_step(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    const Image& one = a.images[i];
    const Image& other = b.images[i];
    EXPECT_EQ(one.name, other.name);
    EXPECT_EQ(one.width, other.width);
    EXPECT_EQ(one.height, other.height);
    EXPECT_EQ(one.levels, other.levels);
    EXPECT_EQ(one.srgb, other.srgb);
    EXPECT_EQ(one.pixels, other.pixels);
    ASSERT_TRUE(one.file && other.file);
    EXPECT_EQ(*one.file, *other.file);
  }
}

void expect_geometry_of_one_step(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_TRUE(same_bytes(a.meshes[i].vertices, b.meshes[i].vertices));
    EXPECT_EQ(a.meshes[i].indices, b.meshes[i].indices);
    EXPECT_EQ(a.meshes[i].material, b.meshes[i].material);
    EXPECT_EQ(a.meshes[i].bounds.maximum, b.meshes[i].bounds.maximum);
  }
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].name, b.nodes[i].name);
    EXPECT_EQ(a.nodes[i].parent, b.nodes[i].parent);
    EXPECT_EQ(a.nodes[i].world, b.nodes[i].world);
  }
  EXPECT_TRUE(same_bytes(a.instances, b.instances));
  EXPECT_EQ(a.shapes.size(), b.shapes.size());
  EXPECT_EQ(a.skins.size(), b.skins.size());
  ASSERT_EQ(a.clips.size(), b.clips.size());
  for (std::size_t i = 0; i < a.clips.size(); ++i) {
    EXPECT_EQ(a.clips[i].name, b.clips[i].name);
    EXPECT_EQ(a.clips[i].channels.at(0).values, b.clips[i].channels.at(0).values);
  }
  EXPECT_EQ(a.deformations.size(), b.deformations.size());
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  EXPECT_EQ(a.cameras.at(0).eye, b.cameras.at(0).eye);
  EXPECT_EQ(a.lights.size(), b.lights.size());
  EXPECT_EQ(a.bounds.minimum, b.bounds.minimum);
  EXPECT_EQ(a.bounds.maximum, b.bounds.maximum);
}

TEST(TwoSteps, GiveTheSameSceneAsOne) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.glb", masked_scene().glb());
  const Scene one = import_gltf(path);
  const Steps steps = import_in_steps(path);
  ASSERT_TRUE(steps.first);
  const Scene& whole = *steps.whole;
  expect_images_of_one_step(whole, one);
  expect_geometry_of_one_step(whole, one);
  EXPECT_EQ(whole.name, one.name);
  EXPECT_EQ(whole.material_names, one.material_names);
  EXPECT_TRUE(same_bytes(whole.materials, one.materials));
  EXPECT_TRUE(same_bytes(whole.layers, one.layers));
  EXPECT_EQ(whole.alpha_heap, one.alpha_heap);
  EXPECT_FALSE(whole.alpha_heap.empty());
  EXPECT_EQ(whole.textures.size(), one.textures.size());
  EXPECT_EQ(whole.warnings, one.warnings);
  EXPECT_EQ(whole.sources, one.sources);
  EXPECT_EQ(whole.scenes, one.scenes);
  EXPECT_EQ(whole.bytes(), one.bytes());
}

TEST(TwoSteps, ShareTheirGeometry) {
  const TemporaryFolder folder;
  const Steps steps = import_in_steps(folder.write("scene.glb", masked_scene().glb()));
  EXPECT_TRUE(steps.whole->meshes.shares_with(steps.first->meshes));
  EXPECT_TRUE(steps.whole->nodes.shares_with(steps.first->nodes));
  EXPECT_TRUE(steps.whole->shapes.shares_with(steps.first->shapes));
  EXPECT_TRUE(steps.whole->clips.shares_with(steps.first->clips));
  expect_geometry_of_one_step(*steps.first, *steps.whole);
}

TEST(TwoSteps, BeginWithoutAnyTexture) {
  const TemporaryFolder folder;
  const Steps steps = import_in_steps(folder.write("scene.glb", masked_scene().glb()));
  Scene& first = *steps.first;
  EXPECT_TRUE(first.images.empty() && first.textures.empty() && first.alpha_heap.empty());
  ASSERT_EQ(first.materials.size(), 1u);
  shared::Material& material = first.materials[0];
  for (const TextureKind& kind : texture_kinds()) {
    EXPECT_EQ(kind.of(material, first.material_layers[0]).texture, shared::no_texture) << kind.name;
  }
  EXPECT_EQ(material.emissive, glm::vec3(0.0f)) << "a texture is dark nearly everywhere";
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.alpha_mask, shared::no_texture) << "surfaces with a mask are whole";
  EXPECT_EQ(steps.image_bytes, steps.whole->images.at(0).file->size());
}

TEST(TwoSteps, AreForScenesWithEnoughBytesOfImages) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.glb", masked_scene().glb());
  const std::uint64_t bytes = import_in_steps(path).image_bytes;
  EXPECT_TRUE(import_in_steps(path, {}, bytes).first);
  EXPECT_FALSE(import_in_steps(path, {}, bytes + 1).first);
  EXPECT_FALSE(import_in_steps(folder.write("plain.glb", triangle().glb()), {}, 1).first);
}

TEST(TwoSteps, CountFilesBesideTheScene) {
  const TemporaryFolder folder;
  const Bytes file = png(2, 2, 4, Bytes(16, 200));
  folder.write("image.png", file);
  GltfBuilder builder = masked_scene();
  builder.json["images"] = {{{"uri", "image.png"}}};
  EXPECT_EQ(import_in_steps(folder.write("scene.glb", builder.glb())).image_bytes, file.size());
  std::filesystem::remove(folder.path() / "image.png");
  const Steps missing = import_in_steps(folder.write("scene.glb", builder.glb()));
  EXPECT_TRUE(missing.first);
  EXPECT_EQ(missing.image_bytes, 0u);
}

TEST(TwoSteps, CanBeCancelledBetween) {
  const TemporaryFolder folder;
  std::stop_source stop;
  ImportOptions options;
  options.stop = stop.get_token();
  options.untextured = [&](std::unique_ptr<Scene>, std::uint64_t) { stop.request_stop(); };
  EXPECT_THROW(import_gltf(folder.write("scene.glb", masked_scene().glb()), {}, options),
               LoadCancelled);
}

TEST(TwoSteps, RefuseADamagedImageInTheSecond) {
  const TemporaryFolder folder;
  GltfBuilder builder = masked_scene();
  builder.json["images"] = nlohmann::json::array();
  Bytes damaged = png(2, 2, 4, Bytes(16, 200));
  damaged.resize(damaged.size() - 20);
  builder.add_image(damaged);
  const auto path = folder.write("scene.glb", builder.glb());
  EXPECT_TRUE(import_in_steps(path).first) << "shown without it";
  bool first = false;
  ImportOptions options;
  options.untextured = [&](std::unique_ptr<Scene>, std::uint64_t) { first = true; };
  EXPECT_THROW(import_gltf(path, strict_limits, options), ImportError);
  EXPECT_TRUE(first);
}

TEST(SharedList, CopiesShareUntilOneIsChanged) {
  SharedList<int> list{1, 2, 3};
  SharedList<int> copy = list;
  EXPECT_TRUE(copy.shares_with(list));
  copy[1] = 7;
  EXPECT_FALSE(copy.shares_with(list));
  EXPECT_EQ(list[1], 2);
  EXPECT_EQ(copy[1], 7);
  EXPECT_EQ(copy[2], 3);
  list.push_back(4);
  EXPECT_EQ(list.size(), 4u);
  EXPECT_TRUE(SharedList<int>().empty());
}

}  // namespace
}  // namespace heliograph::scene::test
