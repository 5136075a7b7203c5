#include "scenes/generator/geometry/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace heliograph::scenes {
namespace {

TEST(Profile, BulgeOneIsHalfCircleWithExactNormals) {
  Profile profile({1.0f, 0.0f});
  profile.arc_to({1.0f, 2.0f}, 1.0f, 16);
  for (const ProfilePoint& point : profile.runs().front()) {
    const glm::vec2 spoke = point.position - glm::vec2(1.0f, 1.0f);
    EXPECT_NEAR(glm::length(spoke), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(glm::normalize(spoke), point.normal), 1.0f, 1e-5f);
  }
}

TEST(Profile, ConcaveArcNormalsPointToCenter) {
  Profile profile({1.0f, 0.0f});
  profile.arc_to({1.0f, 2.0f}, -1.0f, 8);
  const ProfilePoint& middle = profile.runs().front()[4];
  EXPECT_NEAR(middle.position.x, 0.0f, 1e-5f);
  EXPECT_NEAR(middle.normal.x, 1.0f, 1e-5f);
}

// A shared normal on both sides of a crease would shade a cylinder's rim as round.
TEST(Lathe, KeepsCreasesSharp) {
  Profile profile({1.0f, 0.0f});
  profile.line_to({1.0f, 1.0f}).line_to({0.5f, 1.0f});
  const Mesh mesh = lathe(profile, 12, 1.0f, 1.0f);
  for (const Vertex& vertex : mesh.vertices) {
    const bool on_side = std::abs(vertex.normal.y) < 1e-6f;
    const bool on_top = vertex.normal.y > 1.0f - 1e-6f;
    EXPECT_TRUE(on_side || on_top);
  }
}

TEST(Lathe, TextureRepeatsIntegralTimesAround) {
  Profile profile({0.37f, 0.0f});
  profile.line_to({0.37f, 1.0f});
  const Mesh mesh = lathe(profile, 8, 0.37f, 0.6f);
  float widest = 0.0f;
  for (const Vertex& vertex : mesh.vertices) widest = std::max(widest, vertex.uv.x);
  EXPECT_NEAR(widest / 0.6f, std::round(widest / 0.6f), 1e-5f);
}

double signed_volume(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position);
    const glm::dvec3 b(mesh.vertices[mesh.indices[i + 1]].position);
    const glm::dvec3 c(mesh.vertices[mesh.indices[i + 2]].position);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

TEST(Shapes, ClosedShapesHavePositiveVolume) {
  EXPECT_NEAR(signed_volume(box({1, 2, 3})), 6.0, 1e-5);
  EXPECT_NEAR(signed_volume(bevelled_box({1, 2, 3}, 0.05f)), 6.0, 0.05);
  EXPECT_NEAR(signed_volume(sphere(1.0f, 96, 48, glm::vec2(1.0f))), 4.18879, 0.02);
  EXPECT_NEAR(signed_volume(torus(1.0f, 0.25f, 64, 32)), 1.2337, 0.02);
}

TEST(Mesh, MirroredCopiesKeepOutwardFaces) {
  glm::mat4 mirror(1.0f);
  mirror[0][0] = -1.0f;
  Mesh mesh;
  mesh.append(box({1, 1, 1}), mirror);
  EXPECT_NEAR(signed_volume(mesh), 1.0, 1e-6);
}

TEST(Tangents, AreRightHandedOnUprightQuad) {
  Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  compute_tangents(mesh);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, 1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, 1.0f);  // bitangent +Y: the top of the image
  }
}

TEST(Tangents, AreLeftHandedForMirroredTexture) {
  Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  for (Vertex& vertex : mesh.vertices) vertex.uv.x = -vertex.uv.x;
  compute_tangents(mesh);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, -1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, -1.0f);
  }
}

}  // namespace
}  // namespace heliograph::scenes
