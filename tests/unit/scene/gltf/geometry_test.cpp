#include <gtest/gtest.h>

#include <glm/packing.hpp>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

void expect_vector(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(actual, expected), tolerance)
      << actual.x << " " << actual.y << " " << actual.z << " is not " << expected.x << " "
      << expected.y << " " << expected.z;
}

// Five points that form different triangles in every mode.
GltfBuilder five_points(int mode) {
  GltfBuilder builder;
  const auto position = builder.add_accessor(
      std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, 5126, "VEC3", 5);
  const auto normal = builder.add_accessor(
      std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 5);
  builder.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"mode", mode}});
  return builder;
}

TEST(Geometry, ReadsTriangleWithoutIndicesOrNormals) {
  const Scene scene = triangle().import();
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.triangle_count(), 1u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  for (const shared::Vertex& vertex : mesh.vertices) {
    expect_vector(vertex.normal, {0, 0, 1});
    EXPECT_EQ(vertex.color_rg, 0xffffffffu);
    EXPECT_EQ(vertex.color_ba, 0xffffffffu);
    EXPECT_NEAR(glm::dot(glm::vec3(vertex.tangent), vertex.normal), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0f, 1e-6f);
  }
  expect_vector(scene.bounds.maximum, {1, 1, 0});
  ASSERT_EQ(scene.materials.size(), 1u) << "the default material is used";
  EXPECT_EQ(mesh.material, 0u);
}

TEST(Geometry, StripsAlternateWinding) {
  const Scene scene = five_points(5).import();
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
}

TEST(Geometry, FansShareFirstVertex) {
  const Scene scene = five_points(6).import();
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(Geometry, PointsAndLinesAreSkippedWithWarning) {
  for (int mode = 0; mode < 4; ++mode) {
    const Scene scene = five_points(mode).import();
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_TRUE(scene.instances.empty());
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("points and lines"), std::string::npos);
  }
}

TEST(Geometry, IncompleteTriangleIsDropped) {
  const Scene scene = five_points(4).import();
  EXPECT_EQ(scene.meshes[0].indices.size(), 3u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

template <typename T>
void expect_indices_of_type(int component_type) {
  GltfBuilder builder = five_points(4);
  builder.json["meshes"][0]["primitives"][0]["indices"] =
      builder.add_accessor(std::vector<T>{4, 2, 3, 0, 1, 2}, component_type, "SCALAR", 6);
  EXPECT_EQ(builder.import().meshes[0].indices, (std::vector<std::uint32_t>{4, 2, 3, 0, 1, 2}));
}

TEST(Geometry, IndicesOfEveryType) {
  expect_indices_of_type<std::uint8_t>(5121);
  expect_indices_of_type<std::uint16_t>(5123);
  expect_indices_of_type<std::uint32_t>(5125);
}

TEST(Geometry, InterleavedAttributesUseStride) {
  GltfBuilder builder;
  const std::vector<float> interleaved = {0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2};
  const auto view = builder.add_view(interleaved, 24);
  const auto position = builder.add_accessor(view, 5126, "VEC3", 3);
  const auto normal = builder.add_accessor(view, 5126, "VEC3", 3);
  builder.json["accessors"][normal]["byteOffset"] = 12;
  builder.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  const Mesh mesh = builder.import().meshes[0];
  expect_vector(mesh.vertices[1].position, {1, 0, 0});
  expect_vector(mesh.vertices[2].position, {0, 1, 0});
  expect_vector(mesh.vertices[2].normal, {0, 0, 1});  // normalized
}

TEST(Geometry, NormalizedIntegersFollowSpecification) {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = builder.add_accessor(
      builder.add_view(std::vector<std::uint8_t>{0, 255, 0, 0, 51, 0, 0, 0, 255, 255, 0, 0}, 4),
      5121, "VEC2", 3, true);
  attributes["TEXCOORD_1"] = builder.add_accessor(
      builder.add_view(std::vector<std::uint16_t>{0, 65535, 13107, 0, 65535, 65535}), 5123, "VEC2",
      3, true);
  attributes["NORMAL"] = builder.add_accessor(
      builder.add_view(std::vector<std::int8_t>{0, 0, 127, 0, 127, 0, 127, 0, 0, -128, 0, 0}, 4),
      5120, "VEC3", 3, true);
  const Mesh mesh = builder.import().meshes[0];
  EXPECT_EQ(mesh.vertices[0].uv0, glm::vec2(0.0f, 1.0f));
  EXPECT_NEAR(mesh.vertices[1].uv0.x, 0.2f, 1e-6f);
  EXPECT_NEAR(mesh.vertices[1].uv1.x, 0.2f, 1e-6f);
  // Bytes 127 0 127: one each along x and z.
  expect_vector(mesh.vertices[1].normal, {0.7071068f, 0.0f, 0.7071068f});
  expect_vector(mesh.vertices[2].normal, {0, -1, 0});
}

TEST(Geometry, QuantizedPositionsNeedNoConversion) {
  GltfBuilder builder;
  const auto view =
      builder.add_view(std::vector<std::uint16_t>{0, 0, 0, 0, 65535, 0, 0, 0, 0, 300, 0, 0}, 8);
  const auto position = builder.add_accessor(view, 5123, "VEC3", 3, true);
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.show({{"attributes", {{"POSITION", position}}}});
  expect_vector(builder.import().bounds.maximum, {1, 300.0f / 65535.0f, 0});
  builder.json["accessors"][position].erase("normalized");
  expect_vector(builder.import().bounds.maximum, {65535, 300, 0});
}

TEST(Geometry, VertexColorsHaveSixteenBits) {
  GltfBuilder builder = triangle();
  json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["COLOR_0"] = builder.add_accessor(
      std::vector<float>{1, .5f, 0, 0, .25f, 1, .1f, .2f, .3f}, 5126, "VEC3", 3);
  const Mesh mesh = builder.import().meshes[0];
  const glm::vec2 red_green = glm::unpackUnorm2x16(mesh.vertices[0].color_rg);
  const glm::vec2 blue_alpha = glm::unpackUnorm2x16(mesh.vertices[1].color_ba);
  EXPECT_NEAR(red_green.x, 1.0f, 1e-4f);
  EXPECT_NEAR(red_green.y, 0.5f, 1e-4f);
  EXPECT_NEAR(blue_alpha.x, 1.0f, 1e-4f);
  EXPECT_NEAR(blue_alpha.y, 1.0f, 1e-4f) << "without alpha the color is opaque";
}

TEST(Geometry, SparseAccessorsReplaceElements) {
  GltfBuilder builder = triangle();
  const auto indices = builder.add_view(std::vector<std::uint8_t>{1});
  const auto values = builder.add_view(std::vector<float>{7, 0, 0});
  builder.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  EXPECT_EQ(builder.import().bounds.maximum, glm::vec3(7, 1, 0));
  // Without a buffer view all other elements are zero.
  builder.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(builder.import().bounds.maximum, glm::vec3(7, 0, 0));
}

TEST(Geometry, SparseAccessorsWithoutBufferViewStartAtZero) {
  GltfBuilder builder = triangle();
  const auto indices = builder.add_view(std::vector<std::uint8_t>{1, 2});
  const auto values = builder.add_view(std::vector<float>{2, 0, 0, 0, 3, 0});
  builder.json["accessors"][0].erase("bufferView");
  builder.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  const std::vector<shared::Vertex> vertices = builder.import().meshes[0].vertices;
  EXPECT_EQ(vertices[0].position, glm::vec3(0.0f));
  EXPECT_EQ(vertices[1].position, glm::vec3(2, 0, 0));
  EXPECT_EQ(vertices[2].position, glm::vec3(0, 3, 0));
}

TEST(Geometry, EightJointWeightsAreNormalized) {
  GltfBuilder builder = triangle();
  auto& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  const std::vector<std::uint16_t> first = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  const std::vector<std::uint8_t> second = {4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7};
  attributes["JOINTS_0"] = builder.add_accessor(first, 5123, "VEC4", 3);
  attributes["JOINTS_1"] = builder.add_accessor(second, 5121, "VEC4", 3);
  // Normalized bytes that sum to 2 are halved.
  const std::vector<std::uint8_t> heavy = {102, 51, 51, 51, 102, 51, 51, 51, 102, 51, 51, 51};
  const auto weights = builder.add_accessor(builder.add_view(heavy), 5121, "VEC4", 3, true);
  attributes["WEIGHTS_0"] = weights;
  attributes["WEIGHTS_1"] = weights;
  nlohmann::json joints = nlohmann::json::array();
  for (int i = 0; i < 8; ++i) {
    const auto node = builder.add("nodes", nlohmann::json::object());
    builder.json["scenes"][0]["nodes"].push_back(node);
    joints.push_back(node);
  }
  builder.add("skins", {{"joints", joints}});
  builder.json["nodes"][0]["skin"] = 0;
  const Scene scene = builder.import();
  const Shape& shape = scene.shapes.at(0);
  ASSERT_EQ(shape.joints_per_vertex, 8u);
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    EXPECT_EQ(shape.influences[8 + lane].joint, lane);
    EXPECT_NEAR(shape.influences[8 + lane].weight, lane % 4 == 0 ? 0.2f : 0.1f, 1e-6f);
  }
}

TEST(Geometry, FlatNormalsSplitVertices) {
  GltfBuilder builder;
  const auto position =
      builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC3", 4);
  const auto indices =
      builder.add_accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 5121, "SCALAR", 6);
  builder.show({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  const Mesh mesh = builder.import().meshes[0];
  ASSERT_EQ(mesh.vertices.size(), 6u);
  for (int i = 0; i < 3; ++i) expect_vector(mesh.vertices[mesh.indices[i]].normal, {0, 0, 1});
  for (int i = 3; i < 6; ++i) expect_vector(mesh.vertices[mesh.indices[i]].normal, {1, 0, 0});
}

TEST(Geometry, ZeroNormalsBecomeFaceNormals) {
  GltfBuilder builder = triangle();
  builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      builder.add_accessor(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 5, 0}, 5126, "VEC3", 3);
  const Mesh mesh = builder.import().meshes[0];
  expect_vector(mesh.vertices[0].normal, {0, 0, 1});
  expect_vector(mesh.vertices[2].normal, {0, 1, 0});
}

TEST(Geometry, DegenerateTrianglesHaveFiniteFrames) {
  GltfBuilder builder = everything();
  const std::size_t offset = builder.json["bufferViews"][0]["byteOffset"];
  std::fill_n(builder.binary.begin() + offset, 48, std::uint8_t(0));
  builder.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  const Scene scene = builder.import();
  for (const shared::Vertex& vertex : scene.meshes[0].vertices) {
    EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0f, 1e-5f);
  }
}

TEST(Geometry, PrimitivesBecomeSeparateMeshes) {
  GltfBuilder builder = triangle();
  json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  builder.json["meshes"][0]["name"] = "pair";
  const Scene scene = builder.import();
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[1].name, "pair.1");
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[1].mesh, 1u);
  EXPECT_EQ(scene.instances[1].node, 0u);
}

TEST(Geometry, SharedMeshIsStoredOnce) {
  GltfBuilder builder = triangle();
  builder.add("nodes", {{"mesh", 0}, {"translation", {5, 0, 0}}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  const Scene scene = builder.import();
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.triangle_count(), 2u);
  expect_vector(scene.bounds.maximum, {6, 1, 0});
}

TEST(Geometry, ZeroScaleIsSkippedWithWarning) {
  GltfBuilder builder = triangle();
  builder.json["nodes"][0]["scale"] = {0, 0, 0};
  const Scene scene = builder.import();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace heliograph::scene::test
