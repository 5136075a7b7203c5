#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scene/animation/deform.hpp"
#include "scene/surface/surface_anchor.hpp"
#include "scene/surface/surface_snap.hpp"

namespace heliograph::scene {
namespace {

/// The unit square in z = 0 as two triangles with vertices of their own, and a second one that
/// stands on its right side.
struct Corner {
  std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0},
                                   {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 1},
                                   {1, 1, 1}, {1, 0, 0}, {1, 1, 1}, {1, 1, 0}};
  std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

  SnappedPoint snap(glm::vec2 at, float radius, bool vertices = true, bool edges = true) const {
    return *snap_to_mesh(positions, indices,
                         {.origin = {at, 5},
                          .direction = {0, 0, -1},
                          .distance = 5.01f,
                          .radius = radius,
                          .vertices = vertices,
                          .edges = edges});
  }
};

TEST(SurfaceSnap, MeetsTheTriangleExactlyWhereThePickIsRough) {
  const SnappedPoint point = Corner().snap({0.25f, 0.625f}, 0.1f);
  EXPECT_EQ(point.feature, SurfaceFeature::face);
  EXPECT_EQ(point.position, glm::vec3(0.25f, 0.625f, 0.0f));
  EXPECT_EQ(point.triangle, 1u);
  EXPECT_NEAR(point.barycentrics.x + point.barycentrics.y + point.barycentrics.z, 1.0f, 1e-6f);
}

TEST(SurfaceSnap, PrefersVerticesToEdgesWithinTheRadius) {
  const Corner corner;
  const SnappedPoint vertex = corner.snap({0.93f, 0.04f}, 0.1f);
  EXPECT_EQ(vertex.feature, SurfaceFeature::vertex);
  EXPECT_EQ(vertex.position, glm::vec3(1, 0, 0));
  const SnappedPoint edge = corner.snap({0.93f, 0.04f}, 0.1f, false);
  EXPECT_EQ(edge.feature, SurfaceFeature::edge);
  EXPECT_EQ(edge.position, glm::vec3(0.93f, 0, 0));
  EXPECT_EQ(corner.snap({0.93f, 0.04f}, 0.1f, false, false).feature, SurfaceFeature::face);
  EXPECT_EQ(corner.snap({0.8f, 0.2f}, 0.1f).feature, SurfaceFeature::face) << "out of reach";
}

TEST(SurfaceSnap, IgnoresEdgesInsideAFlatFace) {
  const Corner corner;
  EXPECT_EQ(corner.snap({0.5f, 0.52f}, 0.1f).feature, SurfaceFeature::face) << "the diagonal";
  const SnappedPoint crease = corner.snap({0.95f, 0.5f}, 0.1f);
  EXPECT_EQ(crease.feature, SurfaceFeature::edge);
  EXPECT_FLOAT_EQ(crease.position.x, 1.0f);
}

TEST(SurfaceSnap, TakesTheNearestPointWhereTheRayJustMisses) {
  const SnappedPoint point = Corner().snap({-0.001f, 0.5f}, 0.0f);
  EXPECT_NEAR(glm::distance(point.position, glm::vec3(0, 0.5f, 0)), 0.0f, 1e-5f);
  EXPECT_FALSE(snap_to_mesh({}, {}, {.origin = {}, .direction = {0, 0, 1}}));
}

/// A triangle of three joints' weights, which bends.
Scene bending_triangle() {
  Scene scene;
  scene.nodes.resize(3);
  Shape shape;
  shape.joints_per_vertex = 2;
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    shared::Vertex vertex{};
    vertex.position = {i == 1, i == 2, 0.0f};
    vertex.normal = {0, 0, 1};
    vertex.tangent = {1, 0, 0, 1};
    mesh.vertices.push_back(vertex);
    const float share = 0.5f * static_cast<float>(i);
    shape.influences.push_back({0, share});
    shape.influences.push_back({1, 1.0f - share});
  }
  mesh.indices = {0, 1, 2};
  shape.vertices = mesh.vertices;
  scene.meshes.push_back(mesh);
  scene.shapes.push_back(shape);
  scene.skins.push_back({{1, 2}, {glm::mat4(1.0f), glm::mat4(1.0f)}});
  scene.deformations.push_back({0, 0, 0, 0u});
  scene.instances.push_back({0, 0});
  return scene;
}

TEST(SurfaceAnchor, StaysOnItsTriangleWhileTheMeshDeforms) {
  const Scene scene = bending_triangle();
  Pose pose = rest_pose(scene);
  const SurfaceAnchor anchor{.instance = 0, .triangle = 0, .barycentrics = {0.2f, 0.3f, 0.5f}};
  EXPECT_EQ(locate(scene, pose, anchor).position, glm::vec3(0.3f, 0.5f, 0.0f));
  pose.worlds[1] = glm::rotate(glm::mat4(1.0f), 1.0f, {1, 0, 0});
  pose.worlds[2] = glm::translate(glm::mat4(1.0f), {0, 0, 4});
  std::array<shared::Vertex, 3> moved;
  deform(scene, scene.deformations[0], pose, moved);
  const glm::vec3 expected =
      0.2f * moved[0].position + 0.3f * moved[1].position + 0.5f * moved[2].position;
  const SurfaceLocation found = locate(scene, pose, anchor);
  EXPECT_NEAR(glm::distance(found.position, expected), 0.0f, 1e-6f);
  EXPECT_GT(glm::distance(found.position, glm::vec3(0.3f, 0.5f, 0.0f)), 0.5f);
  EXPECT_NEAR(glm::length(found.normal), 1.0f, 1e-6f);
  const auto positions = world_positions(scene, pose, 0);
  EXPECT_EQ(positions[2], moved[2].position);
}

TEST(SurfaceAnchor, KnowsTheTrianglesOfTheScene) {
  const Scene scene = bending_triangle();
  EXPECT_TRUE(has_triangle(scene, {.instance = 0, .triangle = 0}));
  EXPECT_FALSE(has_triangle(scene, {.instance = 0, .triangle = 1}));
  EXPECT_FALSE(has_triangle(scene, {.instance = 1, .triangle = 0}));
}

}  // namespace
}  // namespace heliograph::scene
