#include "scenes/generator/geometry/icosphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace heliograph::scenes {
namespace {

TEST(Icosphere, EachLevelHasFourTimesAsManyTriangles) {
  std::size_t triangles = 20;
  for (int level = 0; level < 5; ++level, triangles *= 4) {
    EXPECT_EQ(icosphere(1.0f, level).triangle_count(), triangles);
    EXPECT_EQ(faceted_icosphere(1.0f, level).triangle_count(), triangles);
  }
}

TEST(Icosphere, NormalsAreRadial) {
  for (const Vertex& vertex : icosphere(2.0f, 3).vertices) {
    EXPECT_NEAR(glm::length(vertex.position), 2.0f, 1e-5f);
    EXPECT_GT(glm::dot(vertex.normal, vertex.position), 1.99999f);
  }
}

// A triangle that crosses the uv seam must not span the whole texture.
TEST(Icosphere, UvSeamTrianglesDoNotWrap) {
  constexpr int level = 3;
  const Mesh mesh = icosphere(level, {1.0f, 1.0f}, [](glm::vec3 direction) {
    return SurfacePoint{direction, direction, {}};
  });
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    float low = 1e9f;
    float high = -1e9f;
    for (std::size_t k = 0; k < 3; ++k) {
      low = std::min(low, mesh.vertices[mesh.indices[i + k]].uv.x);
      high = std::max(high, mesh.vertices[mesh.indices[i + k]].uv.x);
    }
    EXPECT_LT(high - low, 0.5f);
  }
}

TEST(Icosphere, FacetsAreFlat) {
  const Mesh mesh = faceted_icosphere(1.0f, 1);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vertex& a = mesh.vertices[mesh.indices[i]];
    for (std::size_t k = 1; k < 3; ++k) {
      const Vertex& b = mesh.vertices[mesh.indices[i + k]];
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_NEAR(glm::dot(a.normal, b.position - a.position), 0.0f, 1e-5f);
    }
  }
}

// Normals of a displaced surface must agree with those of its triangles.
TEST(Icosphere, DisplacedNormalsMatchTriangles) {
  const glm::vec3 axes(1.0f, 2.0f, 0.5f);
  const Mesh mesh = icosphere(5, {1.0f, 1.0f}, [&](glm::vec3 direction) {
    const glm::vec3 position = direction / glm::length(direction / axes);
    return SurfacePoint{position, glm::normalize(position / (axes * axes)), {}};
  });
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vertex& a = mesh.vertices[mesh.indices[i]];
    const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
    const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
    const glm::vec3 face =
        glm::normalize(glm::cross(b.position - a.position, c.position - a.position));
    EXPECT_GT(glm::dot(face, glm::normalize(a.normal + b.normal + c.normal)), 0.99f);
  }
}

}  // namespace
}  // namespace heliograph::scenes
