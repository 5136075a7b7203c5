#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf/geometry/tangents.hpp"
#include "scene/gltf/materials/materials.hpp"

namespace heliograph::scene {
namespace {

using shared::Vertex;

const shared::TextureSlot plain = default_material().normal_texture;

Vertex corner(const glm::vec3& position, const glm::vec2& uv, const glm::vec3& normal = {0, 0, 1}) {
  Vertex vertex{};
  vertex.position = position;
  vertex.normal = normal;
  vertex.uv0 = uv;
  return vertex;
}

TEST(Tangents, UprightTextureHasUpAsBitangent) {
  std::vector<Vertex> vertices = {corner({0, 0, 0}, {0, 1}), corner({1, 0, 0}, {1, 1}),
                                  corner({0, 1, 0}, {0, 0})};
  std::vector<std::uint32_t> indices = {0, 1, 2};
  generate_tangents(vertices, indices, plain);
  for (const Vertex& vertex : vertices) {
    EXPECT_LT(glm::distance(vertex.tangent, glm::vec4(1, 0, 0, 1)), 1e-6f);
    const glm::vec3 bitangent =
        glm::cross(vertex.normal, glm::vec3(vertex.tangent)) * vertex.tangent.w;
    EXPECT_LT(glm::distance(bitangent, glm::vec3(0, 1, 0)), 1e-6f) << "v decreases upwards";
  }
}

TEST(Tangents, MirroredTextureIsLeftHanded) {
  std::vector<Vertex> vertices = {corner({0, 0, 0}, {1, 1}), corner({1, 0, 0}, {0, 1}),
                                  corner({0, 1, 0}, {1, 0})};
  std::vector<std::uint32_t> indices = {0, 1, 2};
  generate_tangents(vertices, indices, plain);
  EXPECT_LT(glm::distance(vertices[0].tangent, glm::vec4(-1, 0, 0, -1)), 1e-6f);
}

TEST(Tangents, VertexOnMirrorSeamIsSplit) {
  // Two triangles left and right of the y axis with the same half of an image.
  std::vector<Vertex> vertices = {corner({0, 0, 0}, {0, 1}), corner({1, 0, 0}, {1, 1}),
                                  corner({0, 1, 0}, {0, 0}), corner({-1, 0, 0}, {1, 1})};
  std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
  generate_tangents(vertices, indices, plain);
  ASSERT_EQ(vertices.size(), 6u) << "the two vertices on the seam";
  for (std::size_t i = 0; i < 6; ++i) {
    const glm::vec4 expected = i < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1);
    EXPECT_LT(glm::distance(vertices[indices[i]].tangent, expected), 1e-6f) << i;
  }
  EXPECT_EQ(vertices[indices[3]].position, glm::vec3(0));
}

TEST(Tangents, EqualVerticesShareAngleWeightedTangent) {
  // A ridge along y with a common normal: triangles of 90 and of 45 degrees with separate vertices.
  // Welding must give both the same tangent at the shared corner.
  const glm::vec3 normal(0, 0, 1);
  std::vector<Vertex> vertices = {
      corner({0, 0, 0}, {0, 1}, normal), corner({1, 0, -1}, {1, 1}, normal),
      corner({0, 1, 0}, {0, 0}, normal), corner({0, 0, 0}, {0, 1}, normal),
      corner({0, 1, 0}, {0, 0}, normal), corner({-1, 0.5f, 1}, {-1, 0.7f}, normal)};
  std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
  generate_tangents(vertices, indices, plain);
  ASSERT_EQ(vertices.size(), 6u);
  EXPECT_LT(glm::distance(vertices[0].tangent, vertices[3].tangent), 1e-6f);
  EXPECT_LT(glm::distance(vertices[2].tangent, vertices[4].tangent), 1e-6f);
}

TEST(Tangents, WeightIsAngleNotArea) {
  // At one corner: tangent x from 90 degrees, tangent y from 45 degrees, independent of size.
  for (const float size : {1.0f, 100.0f}) {
    std::vector<Vertex> vertices = {
        corner({0, 0, 0}, {0, 0}),      corner({1, 0, 0}, {1, 0}),
        corner({0, 1, 0}, {0, -1}),     corner({0, 0, 0}, {0, 0}),
        corner({-size, 0, 0}, {0, -1}), corner({-size, -size, 0}, {-1, -1})};
    std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
    generate_tangents(vertices, indices, plain);
    // Second face: u falls by 1 as y falls by size, so its tangent is +y; both are right-handed.
    const glm::vec3 expected = glm::normalize(glm::vec3(2, 1, 0));
    EXPECT_LT(glm::distance(glm::vec3(vertices[0].tangent), expected), 1e-5f);
    EXPECT_EQ(vertices[0].tangent.w, 1.0f);
  }
}

TEST(Tangents, TextureTransformRotatesFrame) {
  shared::TextureSlot turned = plain;
  turned.transform_row0 = {0, 1, 0, 0};
  turned.transform_row1 = {-1, 0, 0, 0};
  std::vector<Vertex> vertices = {corner({0, 0, 0}, {0, 1}), corner({1, 0, 0}, {1, 1}),
                                  corner({0, 1, 0}, {0, 0})};
  std::vector<std::uint32_t> indices = {0, 1, 2};
  generate_tangents(vertices, indices, turned);
  EXPECT_LT(glm::distance(vertices[0].tangent, glm::vec4(0, -1, 0, 1)), 1e-6f);
}

TEST(Tangents, DegenerateTexCoordsGiveValidFrame) {
  std::vector<Vertex> vertices = {corner({0, 0, 0}, {0, 0}), corner({1, 0, 0}, {0, 0}),
                                  corner({0, 1, 0}, {0, 0})};
  std::vector<std::uint32_t> indices = {0, 1, 2};
  generate_tangents(vertices, indices, plain);
  for (const Vertex& vertex : vertices) {
    EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(glm::vec3(vertex.tangent), vertex.normal), 0.0f, 1e-5f);
    EXPECT_EQ(vertex.tangent.w, 1.0f);
  }
}

TEST(Tangents, PerpendicularVectorForAnyDirection) {
  for (int i = 0; i < 1000; ++i) {
    const float z = -1.0f + 2.0f * (i + 0.5f) / 1000.0f;
    const float angle = 2.3999632f * i;
    const float radius = std::sqrt(1.0f - z * z);
    const glm::vec3 normal(radius * std::cos(angle), radius * std::sin(angle), z);
    const glm::vec3 tangent = perpendicular_to(normal);
    EXPECT_NEAR(glm::dot(tangent, normal), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::length(tangent), 1.0f, 1e-5f);
  }
  EXPECT_NEAR(glm::length(perpendicular_to({0, 0, -1})), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace heliograph::scene
