// KHR_draco_mesh_compression, EXT_meshopt_compression and EXT_texture_webp, with data from the
// reference encoders.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/unit/scene/support/encoders.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

constexpr int grid_side = 12;

/// A curved sheet of 12 x 12 vertices.
DracoInput sheet() {
  DracoInput input;
  for (int y = 0; y < grid_side; ++y) {
    for (int x = 0; x < grid_side; ++x) {
      const float u = float(x) / (grid_side - 1);
      const float v = float(y) / (grid_side - 1);
      input.positions.push_back({4.0f * u, 3.0f * v, std::sin(5.0f * u)});
      input.normals.push_back(glm::normalize(glm::vec3(-1.25f * std::cos(5.0f * u), 0.0f, 1.0f)));
      input.uv.push_back({u, v});
    }
  }
  for (std::uint32_t y = 0; y + 1 < grid_side; ++y) {
    for (std::uint32_t x = 0; x + 1 < grid_side; ++x) {
      const std::uint32_t first = y * grid_side + x;
      for (const std::uint32_t corner : {0u, 1u, 12u, 12u, 1u, 13u}) {
        input.indices.push_back(first + corner);
      }
    }
  }
  return input;
}

/// A document with compressed geometry only: its accessors have no buffer views.
GltfBuilder with_draco(const DracoOutput& compressed) {
  GltfBuilder builder;
  const auto accessor = [&](int component, std::string_view type, std::uint32_t count) {
    return builder.add("accessors",
                       {{"componentType", component}, {"type", type}, {"count", count}});
  };
  json primitive = {{"indices", accessor(5123, "SCALAR", compressed.triangles * 3)}};
  for (const auto& [name, id] : compressed.ids) {
    const bool joints = name == "JOINTS_0";
    const std::string_view type = name == "TEXCOORD_0" ? "VEC2" : joints ? "VEC4" : "VEC3";
    primitive["attributes"][name] = accessor(joints ? 5121 : 5126, type, compressed.vertices);
  }
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", builder.add_view(compressed.bytes)}, {"attributes", compressed.ids}};
  builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  builder.show(primitive);
  return builder;
}

float farthest_from(const std::vector<shared::Vertex>& vertices,
                    const std::vector<glm::vec3>& expected) {
  float farthest = 0.0f;
  for (const shared::Vertex& vertex : vertices) {
    float nearest = 1e9f;
    for (const glm::vec3& point : expected) {
      nearest = std::min(nearest, glm::distance(vertex.position, point));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

class Draco : public testing::TestWithParam<bool> {};

TEST_P(Draco, RoundTrip) {
  DracoInput input = sheet();
  input.sequential = GetParam();
  input.metadata = GetParam();
  const Scene scene = with_draco(draco(input)).import();
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.indices.size(), input.indices.size());
  EXPECT_EQ(mesh.vertices.size(), input.positions.size());
  EXPECT_LT(farthest_from(mesh.vertices, input.positions), 1e-3f);
  for (const shared::Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.uv0.x, vertex.position.x / 4.0f, 1e-3f);
    EXPECT_NEAR(vertex.uv0.y, vertex.position.y / 3.0f, 1e-3f);
    const glm::vec3 normal(-1.25f * std::cos(1.25f * vertex.position.x), 0.0f, 1.0f);
    EXPECT_GT(glm::dot(vertex.normal, glm::normalize(normal)), 0.99f);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]].position; };
    EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).z, 0.0f) << "winding must be kept";
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Draco, testing::Bool(), [](const auto& test) {
  return test.param ? "Sequential" : "Edgebreaker";
});

TEST(DracoGeometry, JointsStayIntegers) {
  DracoInput input = sheet();
  for (std::size_t i = 0; i < input.positions.size(); ++i) input.joints.push_back({1, 0, 0, 0});
  GltfBuilder builder = with_draco(draco(input));
  json& primitive = builder.json["meshes"][0]["primitives"][0];
  const std::vector<float> weights(input.positions.size() * 4, 0.25f);
  primitive["attributes"]["WEIGHTS_0"] =
      builder.add_accessor(weights, 5126, "VEC4", input.positions.size());
  builder.json["nodes"][0]["skin"] = 0;
  builder.add("nodes", json::object());
  builder.json["scenes"][0]["nodes"].push_back(1);
  builder.add("skins", {{"joints", {0, 1}}});
  const Scene scene = builder.import();
  ASSERT_EQ(scene.shapes.size(), 1u);
  ASSERT_EQ(scene.shapes[0].joints_per_vertex, 4u);
  EXPECT_EQ(scene.shapes[0].influences[0].joint, 1u);
  EXPECT_EQ(scene.shapes[0].influences[1].joint, 0u);
}

TEST(DracoGeometry, DamageIsRejected) {
  const GltfBuilder good = with_draco(draco(sheet()));
  ASSERT_EQ(refusal_of(good), "");
  const auto refusal_with = [&](auto change) {
    GltfBuilder builder = good;
    change(builder,
           builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
    return refusal_of(builder);
  };
  const auto expect = [](const std::string& refusal, std::string_view part) {
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
    EXPECT_TRUE(refusal.empty() || refusal.find("meshes[0].primitives[0]") == 0) << refusal;
  };
  expect(refusal_with([](auto& b, auto&) { b.binary[0] = 'X'; }), "is not a Draco stream");
  expect(refusal_with([](auto& b, auto&) { b.binary[6] = 1; }), "version other than 2.2");
  expect(refusal_with([](auto& b, auto&) { b.binary[7] = 0; }), "does not contain a mesh");
  expect(refusal_with([](auto& b, auto&) { b.binary[8] = 7; }), "unknown encoding");
  expect(refusal_with([](auto&, auto& d) { d["bufferView"] = 9; }), "bufferView: 9");
  expect(refusal_with([](auto&, auto& d) { d.erase("attributes"); }), "attributes: is missing");
  expect(refusal_with([](auto&, auto& d) { d["attributes"]["POSITION"] = 77; }),
         "has no attribute for POSITION");
  expect(refusal_with([](auto&, auto& d) { d["attributes"]["COLOR_0"] = 0; }),
         "is not an attribute of the primitive");
  expect(refusal_with(
             [](auto&, auto& d) { d["attributes"]["TEXCOORD_0"] = d["attributes"]["POSITION"]; }),
         "another element type");
  // A face count of three billion, in five bytes.
  expect(refusal_with([](auto& b, auto&) {
           for (int i = 0; i < 4; ++i) b.binary[14 + i] = 0xff;
           b.binary[18] = 0x0b;
         }),
         "limit of");
}

TEST(DracoGeometry, RandomDamageIsSafe) {
  for (const bool sequential : {false, true}) {
    DracoInput input = sheet();
    input.sequential = sequential;
    const DracoOutput compressed = draco(input);
    std::mt19937 random(11);
    ImportLimits limits;
    limits.triangles = 10'000;
    for (int round = 0; round < 400; ++round) {
      DracoOutput damaged = compressed;
      for (int i = 0; i < 3; ++i) {
        damaged.bytes[11 + random() % (damaged.bytes.size() - 11)] =
            static_cast<std::uint8_t>(random());
      }
      refusal_of(with_draco(damaged), limits);
    }
  }
}

/// Adds the compressed form of a buffer view in a second buffer, as encoders do; the first one
/// stays as fallback.
std::uint32_t add_packed_view(GltfBuilder& builder, const Bytes& packed, const json& extension,
                              std::size_t length, std::uint32_t stride = 0) {
  const std::uint32_t view = builder.add_view(packed);
  json& added = builder.json["bufferViews"][view];
  json meshopt = extension;
  meshopt["buffer"] = 0;
  meshopt["byteOffset"] = added["byteOffset"];
  meshopt["byteLength"] = packed.size();
  added = {{"buffer", 1}, {"byteLength", length}};
  if (stride != 0) added["byteStride"] = stride;
  added["extensions"]["EXT_meshopt_compression"] = meshopt;
  return view;
}

template <typename T>
Bytes bytes_of(const std::vector<T>& values) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(values.data());
  return Bytes(first, first + values.size() * sizeof(T));
}

GltfBuilder finish_meshopt(GltfBuilder builder) {
  builder.json["buffers"].push_back(
      {{"byteLength", 1 << 20},
       {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  builder.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  return builder;
}

GltfBuilder with_meshopt() {
  const DracoInput input = sheet();
  const std::size_t count = input.positions.size();
  GltfBuilder builder;
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  const auto attribute = [&](const Bytes& bytes, std::uint32_t stride, int component,
                             std::string_view type, std::string_view filter, bool normalized) {
    const json extension = {
        {"mode", "ATTRIBUTES"}, {"count", count}, {"byteStride", stride}, {"filter", filter}};
    const auto view =
        add_packed_view(builder, pack_vertices(bytes, stride), extension, count * stride, stride);
    return builder.add_accessor(view, component, type, count, normalized);
  };
  std::vector<glm::vec4> normals;
  for (const glm::vec3& normal : input.normals) normals.push_back(glm::vec4(normal, 0.0f));
  const json attributes = {
      {"POSITION", attribute(exponential(input.positions), 12, 5126, "VEC3", "EXPONENTIAL", false)},
      {"NORMAL", attribute(octahedral(normals), 4, 5120, "VEC3", "OCTAHEDRAL", true)},
      {"TEXCOORD_0", attribute(bytes_of(input.uv), 8, 5126, "VEC2", "NONE", false)}};
  const auto indices =
      add_packed_view(builder, pack_triangles(input.indices, count),
                      {{"mode", "TRIANGLES"}, {"count", input.indices.size()}, {"byteStride", 2}},
                      input.indices.size() * 2);
  builder.show({{"attributes", attributes},
                {"indices", builder.add_accessor(indices, 5123, "SCALAR", input.indices.size())}});
  return finish_meshopt(std::move(builder));
}

TEST(Meshopt, RoundTrip) {
  const DracoInput input = sheet();
  const Scene scene = with_meshopt().import();
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.vertices.size(), input.positions.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LT(glm::distance(mesh.vertices[i].position, input.positions[i]), 1e-5f);
    EXPECT_GT(glm::dot(mesh.vertices[i].normal, input.normals[i]), 0.999f);
    EXPECT_EQ(mesh.vertices[i].uv0, input.uv[i]);
  }
  ASSERT_EQ(mesh.indices.size(), input.indices.size());
  // The codec may rotate a triangle's corners, but not flip its winding.
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto smallest = std::min_element(&mesh.indices[i], &mesh.indices[i] + 3);
    std::array<std::uint32_t, 3> turned{};
    std::rotate_copy(&mesh.indices[i], smallest, &mesh.indices[i] + 3, turned.begin());
    const auto expected = std::min_element(&input.indices[i], &input.indices[i] + 3);
    std::array<std::uint32_t, 3> original{};
    std::rotate_copy(&input.indices[i], expected, &input.indices[i] + 3, original.begin());
    EXPECT_EQ(turned, original);
  }
}

TEST(Meshopt, IndexSequencesAndQuaternions) {
  GltfBuilder builder;
  const auto positions =
      builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 5126, "VEC3", 4);
  const std::vector<std::uint32_t> strip = {0, 1, 2, 3};
  const auto indices = add_packed_view(builder, pack_sequence(strip, 4),
                                       {{"mode", "INDICES"}, {"count", 4}, {"byteStride", 4}}, 16);
  builder.show({{"attributes", {{"POSITION", positions}}},
                {"mode", 5},
                {"indices", builder.add_accessor(indices, 5125, "SCALAR", 4)}});
  const std::vector<glm::vec4> rotations = {{0, 0, 0.6f, 0.8f}, {0.8f, 0, 0, -0.6f}};
  const auto turns = add_packed_view(
      builder, pack_vertices(quaternions(rotations), 8),
      {{"mode", "ATTRIBUTES"}, {"count", 2}, {"byteStride", 8}, {"filter", "QUATERNION"}}, 16);
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
      builder.add_accessor(turns, 5122, "VEC4", 2, true);
  const Scene scene = finish_meshopt(std::move(builder)).import();
  EXPECT_EQ(scene.triangle_count(), 4u);
  ASSERT_EQ(scene.instances.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::quat turned = scene.nodes[scene.instances[i].node].transform->rotation;
    const glm::vec4 found(turned.x, turned.y, turned.z, turned.w);
    EXPECT_GT(std::abs(glm::dot(found, rotations[i])), 0.9999f) << "q and -q are the same rotation";
  }
}

TEST(Meshopt, DamageIsRejected) {
  const GltfBuilder good = with_meshopt();
  ASSERT_EQ(refusal_of(good), "");
  const auto refusal_with = [&](std::size_t view, auto change, const ImportLimits& limits = {}) {
    GltfBuilder builder = good;
    change(builder, builder.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]);
    return refusal_of(builder, limits);
  };
  const auto expect = [](const std::string& refusal, std::string_view part) {
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
  };
  expect(refusal_with(0, [](auto&, auto& m) { m["mode"] = "STRIPS"; }), "mode");
  expect(refusal_with(0, [](auto&, auto& m) { m["filter"] = "SEPIA"; }), "filter");
  expect(refusal_with(0, [](auto&, auto& m) { m["byteStride"] = 6; }), "byteStride");
  expect(refusal_with(0, [](auto&, auto& m) { m["byteStride"] = 0; }), "byteStride");
  expect(refusal_with(0, [](auto&, auto& m) { m["filter"] = "QUATERNION"; }), "quaternion");
  expect(refusal_with(0, [](auto&, auto& m) { m["filter"] = "OCTAHEDRAL"; }), "octahedral");
  expect(refusal_with(0, [](auto&, auto& m) { m["count"] = 143; }), "byteLength");
  expect(refusal_with(0, [](auto&, auto& m) { m["count"] = 0xffffffffffffffffull; }),
         "must be at most");
  expect(refusal_with(0, [](auto&, auto& m) { m["count"] = 1ull << 40; }), "limit");
  expect(refusal_with(0, [](auto&, auto& m) { m["buffer"] = 1; }), "without data");
  expect(refusal_with(0, [](auto&, auto& m) { m["byteLength"] = 1 << 30; }), "past the end");
  expect(refusal_with(0, [](auto&, auto& m) { m["byteLength"] = 8; }), "damaged data");
  expect(refusal_with(3, [](auto&, auto& m) { m["byteStride"] = 8; }), "2 or 4");
  expect(refusal_with(3, [](auto&, auto& m) { m["filter"] = "EXPONENTIAL"; }), "attributes only");
  expect(refusal_with(3,
                      [](auto& b, auto& m) {
                        m["count"] = 725;
                        b.json["bufferViews"][3]["byteLength"] = 1450;
                      }),
         "triangles");
  expect(refusal_with(0, [](auto& b, auto&) { b.json["bufferViews"][0].erase("extensions"); }),
         "without data");
  ImportLimits limits;
  limits.unpacked_bytes = 2000;
  expect(refusal_with(
             0, [](auto&, auto&) {}, limits),
         "limit");
}

TEST(Meshopt, RandomDamageIsSafe) {
  const GltfBuilder good = with_meshopt();
  std::mt19937 random(3);
  for (int round = 0; round < 500; ++round) {
    GltfBuilder builder = good;
    for (int i = 0; i < 3; ++i) {
      builder.binary[random() % builder.binary.size()] = static_cast<std::uint8_t>(random());
    }
    refusal_of(builder);
  }
}

Bytes gradient(std::uint32_t width, std::uint32_t height) {
  Bytes rgba;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (const std::uint32_t value : {x * 255 / width, y * 255 / height, 40u, 255u - x}) {
        rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return rgba;
}

TEST(WebP, LosslessRoundTripIsExact) {
  GltfBuilder builder = everything();
  const Bytes rgba = gradient(40, 24);
  const auto image = builder.add_image(webp(40, 24, rgba));
  builder.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = image;
  builder.json["extensionsRequired"] = {"EXT_texture_webp"};
  const Scene scene = builder.import();
  const Image& decoded = scene.images.at(0);
  EXPECT_EQ(decoded.width, 40u);
  ASSERT_EQ(decoded.height, 24u);
  EXPECT_TRUE(std::equal(rgba.begin(), rgba.end(), decoded.pixels.begin()));
}

TEST(WebP, LossyWithoutFallback) {
  GltfBuilder builder = everything();
  const Bytes rgba = gradient(64, 64);
  builder.json["textures"][0].erase("source");
  builder.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] =
      builder.add_image(webp(64, 64, rgba, false));
  const Image decoded = builder.import().images.at(0);
  double difference = 0.0;
  for (std::size_t i = 0; i < rgba.size(); ++i) difference += std::abs(rgba[i] - decoded.pixels[i]);
  EXPECT_LT(difference / static_cast<double>(rgba.size()), 4.0);
}

TEST(WebP, DamageIsRejected) {
  const Bytes good = webp(64, 64, gradient(64, 64), false);
  const auto refusal_with = [](const Bytes& file) {
    GltfBuilder builder = everything();
    builder.json["images"][0]["bufferView"] = builder.add_view(file);
    return refusal_of(builder);
  };
  EXPECT_EQ(refusal_with(good), "");
  for (std::size_t size = 12; size < good.size(); size += good.size() / 20) {
    const std::string refusal = refusal_with(Bytes(good.begin(), good.begin() + size));
    EXPECT_EQ(refusal.find("images[0]"), 0u) << size;
    EXPECT_NE(refusal.find("damaged WebP"), std::string::npos) << refusal;
  }
}

}  // namespace
}  // namespace heliograph::scene::test
