#include "scene/animation/deform.hpp"

#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene {
namespace {

shared::Vertex vertex_at(const glm::vec3& position, const glm::vec3& normal = {0, 0, 1}) {
  shared::Vertex vertex{};
  vertex.position = position;
  vertex.normal = normal;
  vertex.tangent = {1, 0, 0, 1};
  return vertex;
}

/// A shape of `count` random vertices with two joints.
Scene skinned_scene(std::size_t count, std::uint32_t joints_per_vertex) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
  Scene scene;
  scene.nodes.resize(3);
  scene.nodes[1].world = glm::scale(glm::mat4(1.0f), {2, 0.5f, 1});
  scene.nodes[2].world =
      glm::rotate(glm::translate(glm::mat4(1.0f), {0, 1, 0}), 0.7f, {0.6f, 0.8f, 0});
  scene.skins.push_back({{1, 2}, {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0})}});
  Shape shape;
  shape.joints_per_vertex = joints_per_vertex;
  for (std::size_t i = 0; i < count; ++i) {
    shape.vertices.push_back(vertex_at(vector(), glm::normalize(vector())));
    shape.influences.resize((i + 1) * joints_per_vertex);
    const float share = 0.5f + 0.5f * uniform(random);
    shape.influences[i * joints_per_vertex] = {0, share};
    shape.influences[(i + 1) * joints_per_vertex - 1] = {1, 1.0f - share};
  }
  scene.shapes.push_back(shape);
  scene.deformations.push_back({0, 0, 0, 0u});
  return scene;
}

class Skinning : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Skinning, MatchesDefinition) {
  const Scene scene = skinned_scene(5000, GetParam());
  const Shape& shape = scene.shapes[0];
  std::vector<shared::Vertex> moved(shape.vertices.size());
  const Bounds bounds = deform(scene, scene.deformations[0], rest_pose(scene), moved);
  const std::array joints{scene.nodes[1].world,
                          scene.nodes[2].world * scene.skins[0].inverse_bind[1]};
  for (std::size_t i = 0; i < moved.size(); ++i) {
    glm::dmat4 blended(0.0);
    for (std::size_t j = 0; j < GetParam(); ++j) {
      const auto& [joint, weight] = shape.influences[i * GetParam() + j];
      blended += static_cast<double>(weight) * glm::dmat4(joints[joint]);
    }
    const glm::dvec3 position(blended * glm::dvec4(glm::dvec3(shape.vertices[i].position), 1.0));
    ASSERT_LE(glm::distance(glm::dvec3(moved[i].position), position), 1e-5) << i;
    const glm::dmat3 inverse_transpose = glm::transpose(glm::inverse(glm::dmat3(blended)));
    const glm::dvec3 normal =
        glm::normalize(inverse_transpose * glm::dvec3(shape.vertices[i].normal));
    ASSERT_GE(glm::dot(glm::dvec3(moved[i].normal), normal), 1.0 - 1e-5) << i;
    ASSERT_TRUE(glm::all(glm::lessThanEqual(bounds.minimum, moved[i].position)));
    ASSERT_TRUE(glm::all(glm::lessThanEqual(moved[i].position, bounds.maximum)));
  }
}

INSTANTIATE_TEST_SUITE_P(FourAndEightJoints, Skinning, testing::Values(4u, 8u));

// A published renderer multiplied normals by the transpose instead of the inverse transpose: for a
// slope scaled in x by 1/4 the two differ by tens of degrees.
TEST(Skinning, NormalsUseInverseTranspose) {
  Scene scene = skinned_scene(1, 4);
  scene.nodes[1].world = glm::scale(glm::mat4(1.0f), {0.25f, 1, 1});
  Shape& shape = scene.shapes[0];
  shape.vertices[0] = vertex_at({1, 1, 0}, glm::normalize(glm::vec3(1, 1, 0)));
  shape.vertices[0].tangent = glm::vec4(glm::normalize(glm::vec3(1, -1, 0)), 1.0f);
  std::ranges::fill(shape.influences, JointWeight{});
  shape.influences[0] = {0, 1.0f};
  std::vector<shared::Vertex> moved(1);
  deform(scene, scene.deformations[0], rest_pose(scene), moved);
  EXPECT_NEAR(glm::dot(moved[0].normal, glm::vec3(moved[0].tangent)), 0.0f, 1e-6f);
  EXPECT_LE(glm::distance(moved[0].normal, glm::normalize(glm::vec3(4, 1, 0))), 1e-6f);
}

TEST(Skinning, MirroredJointsKeepNormalsOutward) {
  Scene scene = skinned_scene(1, 4);
  scene.nodes[1].world = glm::scale(glm::mat4(1.0f), {-1, 1, 1});
  Shape& shape = scene.shapes[0];
  shape.vertices[0] = vertex_at({1, 0, 0}, {1, 0, 0});
  shape.vertices[0].tangent = {0, 1, 0, 1};
  std::ranges::fill(shape.influences, JointWeight{});
  shape.influences[0] = {0, 1.0f};
  std::vector<shared::Vertex> moved(1);
  deform(scene, scene.deformations[0], rest_pose(scene), moved);
  EXPECT_EQ(moved[0].normal, glm::vec3(-1, 0, 0));
  EXPECT_EQ(moved[0].tangent, glm::vec4(0, 1, 0, -1));
}

TEST(Skinning, NormalsAreUnitLengthAtAnyScale) {
  for (const float size :
       {1e-12f, 1e-6f, 1e6f, 1e12f}) {  // their squares overflow or underflow a float
    Scene scene = skinned_scene(1, 4);
    scene.nodes[1].world = glm::scale(glm::mat4(1.0f), glm::vec3(2.0f * size, size, size));
    Shape& shape = scene.shapes[0];
    shape.vertices[0] = vertex_at({1, 0, 0}, glm::normalize(glm::vec3(1, 1, 0)));
    std::ranges::fill(shape.influences, JointWeight{});
    shape.influences[0] = {0, 1.0f};
    std::vector<shared::Vertex> moved(1);
    deform(scene, scene.deformations[0], rest_pose(scene), moved);
    EXPECT_LE(glm::distance(moved[0].normal, glm::normalize(glm::vec3(1, 2, 0))), 1e-5f) << size;
    EXPECT_LE(glm::distance(glm::vec3(moved[0].tangent), glm::vec3(1, 0, 0)), 1e-5f) << size;
  }
}

TEST(Morphing, AddsWeightedDisplacements) {
  Scene scene;
  scene.nodes.resize(1);
  Shape shape;
  shape.vertices = {vertex_at({1, 2, 3})};
  shape.targets.push_back({{{4, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}});
  shape.targets.push_back({{{0, 8, 0}}, {}, {}});
  scene.shapes.push_back(shape);
  scene.deformations.push_back({0, 0, 0, std::nullopt});
  Pose pose = rest_pose(scene);
  pose.weights[0] = {0.5f, -0.25f};
  std::vector<shared::Vertex> moved(1);
  deform(scene, scene.deformations[0], pose, moved);
  EXPECT_EQ(moved[0].position, glm::vec3(3, 0, 3));
  EXPECT_LE(glm::distance(moved[0].normal, glm::normalize(glm::vec3(0.5f, 0, 1))), 1e-6f);
  EXPECT_LE(glm::distance(glm::vec3(moved[0].tangent), glm::normalize(glm::vec3(1, 0.5f, 0))),
            1e-6f);
}

TEST(Morphing, FlatNormalsAreOfDeformedTriangle) {
  Scene scene;
  scene.nodes.resize(1);
  Shape shape;
  shape.flat = true;
  shape.vertices = {vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})};
  shape.targets.push_back({{{0, 0, 0}, {0, 0, 0}, {0, -1, 1}}, {}, {}});
  scene.shapes.push_back(shape);
  scene.deformations.push_back({0, 0, 0, std::nullopt});
  Pose pose = rest_pose(scene);
  pose.weights[0] = {1.0f};
  std::vector<shared::Vertex> moved(3);
  deform(scene, scene.deformations[0], pose, moved);
  for (const auto& vertex : moved) {
    EXPECT_LE(glm::distance(vertex.normal, {0, -1, 0}), 1e-6f);
  }
}

}  // namespace
}  // namespace heliograph::scene
