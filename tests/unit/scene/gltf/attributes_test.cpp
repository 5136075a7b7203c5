// Every component type of every attribute that glTF and KHR_mesh_quantization permit.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/packing.hpp>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

struct Component {
  int type;  // glTF's enum value
  bool normalized;
  double largest;  // largest integer value; 0: float
};

constexpr Component f32{5126, false, 0.0};
constexpr Component i8{5120, false, 127.0}, i8n{5120, true, 127.0};
constexpr Component u8{5121, false, 255.0}, u8n{5121, true, 255.0};
constexpr Component i16{5122, false, 32767.0}, i16n{5122, true, 32767.0};
constexpr Component u16{5123, false, 65535.0}, u16n{5123, true, 65535.0};

template <typename T>
void append(Bytes& bytes, double value) {
  const T number = static_cast<T>(value);
  const auto* first = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), first, first + sizeof number);
}

void append_as(Bytes& bytes, const Component& component, double value) {
  if (component.normalized) value = std::round(value * component.largest);
  switch (component.type) {
    case 5120:
      return append<std::int8_t>(bytes, value);
    case 5121:
      return append<std::uint8_t>(bytes, value);
    case 5122:
      return append<std::int16_t>(bytes, value);
    case 5123:
      return append<std::uint16_t>(bytes, value);
    default:
      return append<float>(bytes, value);
  }
}

/// `values` in elements of `width` components, padded to 4 bytes (glTF 3.6.2.4).
std::uint32_t add_values(GltfBuilder& builder, const Component& component, std::size_t width,
                         const Numbers& values) {
  Bytes bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    append_as(bytes, component, values[i]);
    if ((i + 1) % width == 0) bytes.resize((bytes.size() + 3) / 4 * 4);
  }
  const std::size_t count = values.size() / width;
  const auto stride = static_cast<std::uint32_t>(bytes.size() / count);
  const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return builder.add_accessor(builder.add_view(bytes, stride), component.type, types[width - 1],
                              count, component.normalized);
}

json& attributes_of(GltfBuilder& builder) {
  return builder.json["meshes"][0]["primitives"][0]["attributes"];
}

/// A triangle with this additional attribute.
Mesh mesh_with(const char* name, const Component& component, std::size_t width,
               const Numbers& values) {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  if (std::string_view(name) == "TANGENT") {
    attributes_of(builder)["NORMAL"] = add_values(builder, f32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  }
  attributes_of(builder)[name] = add_values(builder, component, width, values);
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  return builder.import().meshes.at(0);
}

double step_of(const Component& component) {
  return component.normalized ? 0.51 / component.largest : 1e-6;
}

TEST(Attributes, PositionsOfEveryComponentType) {
  for (const Component& component : {f32, i8n, u8n, i16n, u16n}) {
    const Mesh mesh = mesh_with("POSITION", component, 3, {0, 0, 0, 1, 0, 0, 0, 0.5, 0});
    EXPECT_NEAR(mesh.vertices[1].position.x, 1.0, 1e-6) << component.type;
    EXPECT_NEAR(mesh.vertices[2].position.y, 0.5, step_of(component)) << component.type;
  }
  for (const Component& component : {i8, u8, i16, u16}) {
    const Mesh mesh = mesh_with("POSITION", component, 3, {0, 0, 0, 100, 0, 0, 0, 7, 0});
    EXPECT_EQ(mesh.vertices[1].position, glm::vec3(100, 0, 0)) << component.type;
    EXPECT_EQ(mesh.vertices[2].position, glm::vec3(0, 7, 0)) << component.type;
  }
  for (const Component& component : {i8, i16, i8n, i16n, f32}) {
    const Mesh mesh = mesh_with("POSITION", component, 3, {0, 0, 0, -1, 0, 0, 0, 1, 0});
    EXPECT_NEAR(mesh.vertices[1].position.x, -1.0, 1e-6) << component.type;
  }
}

TEST(Attributes, NormalsAndTangentsOfEveryComponentType) {
  for (const Component& component : {f32, i8n, i16n}) {
    const Mesh normals = mesh_with("NORMAL", component, 3, {0, 0, 1, 0, 0.6, 0.8, -1, 0, 0});
    EXPECT_LE(glm::distance(normals.vertices[1].normal, {0, 0.6f, 0.8f}), 0.01f) << component.type;
    EXPECT_LE(glm::distance(normals.vertices[2].normal, {-1, 0, 0}), 1e-6f) << component.type;
    const Mesh tangents =
        mesh_with("TANGENT", component, 4, {1, 0, 0, 1, 0, 1, 0, -1, 0.6, 0.8, 0, 1});
    EXPECT_EQ(tangents.vertices[1].tangent, glm::vec4(0, 1, 0, -1)) << component.type;
    EXPECT_LE(glm::distance(tangents.vertices[2].tangent, {0.6f, 0.8f, 0, 1}), 0.01f)
        << component.type;
  }
}

// Tangents without normals are ignored (glTF 3.7.2.1).
TEST(Attributes, TangentsWithoutNormalsAreIgnored) {
  GltfBuilder builder = triangle();
  attributes_of(builder)["TANGENT"] =
      add_values(builder, f32, 4, {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1});
  const Scene scene = builder.import();
  for (const shared::Vertex& vertex : scene.meshes[0].vertices) {
    EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    EXPECT_NEAR(glm::dot(glm::vec3(vertex.tangent), vertex.normal), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0f, 1e-6f);
  }
}

TEST(Attributes, BothTexCoordSetsOfEveryComponentType) {
  for (const char* const name : {"TEXCOORD_0", "TEXCOORD_1"}) {
    const auto uv = [&](const Mesh& mesh, std::size_t vertex) {
      return std::string_view(name).ends_with('0') ? mesh.vertices[vertex].uv0
                                                   : mesh.vertices[vertex].uv1;
    };
    for (const Component& component : {f32, i8n, u8n, i16n, u16n}) {
      const Mesh mesh = mesh_with(name, component, 2, {0, 1, 0.25, 0, 1, 0.75});
      EXPECT_EQ(uv(mesh, 0), glm::vec2(0, 1)) << name << component.type;
      EXPECT_NEAR(uv(mesh, 1).x, 0.25, step_of(component)) << name << component.type;
      EXPECT_NEAR(uv(mesh, 2).y, 0.75, step_of(component)) << name << component.type;
    }
    for (const Component& component : {i8, u8, i16, u16}) {
      EXPECT_EQ(uv(mesh_with(name, component, 2, {0, 1, 7, 0, 120, 3}), 2), glm::vec2(120, 3))
          << name << component.type;
    }
  }
}

TEST(Attributes, ColorsOfEveryComponentTypeWithAndWithoutAlpha) {
  for (const Component& component : {f32, u8n, u16n}) {
    const Mesh opaque = mesh_with("COLOR_0", component, 3, {1, 0, 0, 0, 0.25, 0, 0, 0, 0.5});
    EXPECT_NEAR(glm::unpackUnorm2x16(opaque.vertices[0].color_rg).x, 1.0, 1e-6);
    EXPECT_NEAR(glm::unpackUnorm2x16(opaque.vertices[1].color_rg).y, 0.25,
                step_of(component) + 1e-5);
    EXPECT_NEAR(glm::unpackUnorm2x16(opaque.vertices[2].color_ba).x, 0.5,
                step_of(component) + 1e-5);
    EXPECT_NEAR(glm::unpackUnorm2x16(opaque.vertices[2].color_ba).y, 1.0, 1e-6);
    const Mesh clear = mesh_with("COLOR_0", component, 4, {1, 0, 0, 0.5, 0, 1, 0, 1, 0, 0, 1, 0});
    EXPECT_NEAR(glm::unpackUnorm2x16(clear.vertices[0].color_ba).y, 0.5, step_of(component) + 1e-5);
    EXPECT_EQ(glm::unpackUnorm2x16(clear.vertices[2].color_ba).y, 0.0f);
  }
}

TEST(Attributes, JointsAndWeightsOfEveryComponentType) {
  for (const Component& joints : {u8, u16}) {
    for (const Component& weights : {f32, u8n, u16n}) {
      GltfBuilder builder = triangle();
      attributes_of(builder)["JOINTS_0"] =
          add_values(builder, joints, 4, {2, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
      attributes_of(builder)["WEIGHTS_0"] =
          add_values(builder, weights, 4, {0.2, 0.8, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
      for (int i = 0; i < 3; ++i) {
        const auto joint = builder.add("nodes", json::object());
        builder.json["scenes"][0]["nodes"].push_back(joint);
      }
      builder.add("skins", {{"joints", {1, 2, 3}}});
      builder.json["nodes"][0]["skin"] = 0;
      const Scene scene = builder.import();
      const Shape& shape = scene.shapes.at(0);
      EXPECT_EQ(shape.influences[0].joint, 2u);
      EXPECT_NEAR(shape.influences[0].weight, 0.2, step_of(weights) + 1e-6);
      EXPECT_EQ(shape.influences[1].joint, 1u);
      EXPECT_NEAR(shape.influences[1].weight, 0.8, step_of(weights) + 1e-6);
    }
  }
}

TEST(Attributes, SkinsOfSevenHundredJoints) {
  constexpr int joints = 700;
  GltfBuilder builder = triangle();
  attributes_of(builder)["JOINTS_0"] =
      add_values(builder, u16, 4, {699, 0, 0, 0, 350, 0, 0, 0, 0, 0, 0, 0});
  attributes_of(builder)["WEIGHTS_0"] =
      add_values(builder, f32, 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  json list = json::array();
  for (int i = 0; i < joints; ++i) {
    list.push_back(builder.add("nodes", {{"translation", {i, 0, 0}}}));
    builder.json["scenes"][0]["nodes"].push_back(list.back());
  }
  builder.add("skins", {{"joints", list}});
  builder.json["nodes"][0]["skin"] = 0;
  const Scene scene = builder.import();
  const auto& vertices = scene.meshes[scene.instances.at(0).mesh].vertices;
  EXPECT_EQ(vertices[0].position, glm::vec3(699, 0, 0));
  EXPECT_EQ(vertices[1].position, glm::vec3(351, 0, 0));
}

// Strips and fans index corners.
TEST(Attributes, StripsAndFansMayHaveIndices) {
  for (const int mode : {5, 6}) {
    GltfBuilder builder = triangle();
    attributes_of(builder)["NORMAL"] = add_values(builder, f32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
    json& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive["indices"] =
        builder.add_accessor(std::vector<std::uint8_t>{2, 0, 1, 2}, 5121, "SCALAR", 4);
    EXPECT_EQ(builder.import().meshes[0].indices,
              mode == 5 ? (std::vector<std::uint32_t>{2, 0, 1, 0, 2, 1})
                        : (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 2}));
  }
}

TEST(Attributes, SparseIndicesOfEveryTypeReplaceAnyElementType) {
  const auto with_sparse = [](int type, std::uint32_t indices_view, GltfBuilder& builder,
                              std::uint32_t accessor, std::uint32_t values) {
    builder.json["accessors"][accessor]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices_view}, {"componentType", type}}},
        {"values", {{"bufferView", values}}}};
  };
  for (const int type : {5121, 5123, 5125}) {
    GltfBuilder builder = triangle();
    // Index 1 in every width.
    const auto index = builder.add_view(Bytes{1, 0, 0, 0});
    const auto uv = add_values(builder, u16n, 2, {0, 0, 0, 0, 0, 0});
    with_sparse(type, index, builder, uv,
                builder.add_view(std::vector<std::uint16_t>{65535, 13107}));
    attributes_of(builder)["TEXCOORD_0"] = uv;
    const auto corners =
        builder.add_accessor(std::vector<std::uint16_t>{0, 0, 2}, 5123, "SCALAR", 3);
    with_sparse(type, index, builder, corners, builder.add_view(std::vector<std::uint16_t>{1, 0}));
    builder.json["meshes"][0]["primitives"][0]["indices"] = corners;
    const Mesh mesh = builder.import().meshes[0];
    EXPECT_EQ(mesh.vertices[mesh.indices[1]].position, glm::vec3(1, 0, 0)) << type;
    EXPECT_NEAR(mesh.vertices[mesh.indices[1]].uv0.x, 1.0f, 1e-6f) << type;
    EXPECT_NEAR(mesh.vertices[mesh.indices[1]].uv0.y, 0.2f, 1e-5f) << type;
    EXPECT_EQ(mesh.vertices[mesh.indices[0]].uv0, glm::vec2(0.0f)) << type;
  }
}

TEST(Attributes, MorphTargetsOfEveryComponentTypeMoveNormalsAndTangents) {
  for (const Component& component : {f32, i8n, i16n}) {
    GltfBuilder builder = triangle();
    builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    attributes_of(builder)["NORMAL"] = add_values(builder, f32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes_of(builder)["TANGENT"] =
        add_values(builder, f32, 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
    json target;
    target["POSITION"] = add_values(builder, component, 3, {0, 0, 0, 0, 0, 1, 0, 0, 0});
    target["NORMAL"] = add_values(builder, component, 3, {0, 0, 0, -1, 0, -1, 0, 0, 0});
    target["TANGENT"] = add_values(builder, component, 3, {0, 0, 0, -1, 0, 1, 0, 0, 0});
    builder.json["meshes"][0]["primitives"][0]["targets"] = {target};
    builder.json["meshes"][0]["weights"] = {1};
    const Scene scene = builder.import();
    const MorphTarget& read = scene.shapes.at(0).targets.at(0);
    EXPECT_EQ(read.normals.at(1), glm::vec3(-1, 0, -1)) << component.type;
    const shared::Vertex& moved = scene.meshes[scene.instances.at(0).mesh].vertices[1];
    EXPECT_LE(glm::distance(moved.position, {1, 0, 1}), 1e-6f) << component.type;
    EXPECT_LE(glm::distance(moved.normal, {-1, 0, 0}), 1e-6f) << component.type;
    EXPECT_LE(glm::distance(moved.tangent, {0, 0, 1, 1}), 1e-6f) << component.type;
  }
}

}  // namespace
}  // namespace heliograph::scene::test
