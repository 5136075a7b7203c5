#include "scene/animation/explosion.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace heliograph::scene {
namespace {

/// A node at `at` below `parent`, with a cube of side 2, unless it only groups.
std::uint32_t add_node(Scene& scene, std::optional<std::uint32_t> parent, const glm::vec3& at,
                       bool cube = true) {
  const auto number = static_cast<std::uint32_t>(scene.nodes.size());
  scene.nodes.push_back({.name = std::to_string(number),
                         .parent = parent,
                         .world = glm::translate(glm::mat4(1.0f), at)});
  if (!cube) return number;
  if (scene.meshes.empty()) {
    scene.meshes.emplace_back().bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
  }
  scene.instances.push_back({.mesh = 0, .node = number});
  return number;
}

glm::vec3 place(const Scene& scene, float amount, std::uint32_t node) {
  Pose pose = rest_pose(scene);
  Explosion(scene).apply(amount, pose);
  return glm::vec3(pose.worlds[node][3]);
}

TEST(Explosion, MovesPartsAwayFromTheMiddle) {
  Scene scene;
  const auto left = add_node(scene, {}, {-3, 0, 0});
  const auto right = add_node(scene, {}, {5, 0, 0});
  EXPECT_EQ(place(scene, 0.0f, left), glm::vec3(-3, 0, 0));
  EXPECT_EQ(place(scene, 0.5f, left), glm::vec3(-5, 0, 0)) << "the middle is at 1";
  EXPECT_EQ(place(scene, 0.5f, right), glm::vec3(7, 0, 0));
}

TEST(Explosion, KeepsAssembliesTogetherAsTheHierarchySays) {
  Scene scene;
  const auto group = add_node(scene, {}, {0, 0, 0}, false);
  const auto one = add_node(scene, group, {9, 0, -2});
  const auto other = add_node(scene, group, {9, 0, 2});
  const auto alone = add_node(scene, {}, {-9, 0, 0});
  EXPECT_EQ(place(scene, 1.0f, alone), glm::vec3(-18, 0, 0));
  EXPECT_EQ(place(scene, 1.0f, one), glm::vec3(18, 0, -4)) << "with its group, and from its middle";
  EXPECT_EQ(place(scene, 1.0f, other), glm::vec3(18, 0, 4));
  EXPECT_EQ(place(scene, 1.0f, group), glm::vec3(0)) << "what has no mesh stays";
}

TEST(Explosion, SinksNothingBelowTheLowestPoint) {
  Scene scene;
  const auto low = add_node(scene, {}, {0, 1, 0});
  const auto high = add_node(scene, {}, {0, 5, 0});
  EXPECT_EQ(place(scene, 1.0f, low), glm::vec3(0, 1, 0)) << "stands where it stood";
  EXPECT_EQ(place(scene, 1.0f, high), glm::vec3(0, 9, 0));
  const Pose pose = shown_pose(scene, nullptr, 0.0, 1.0f);
  EXPECT_EQ(posed_bounds(scene, pose).minimum, glm::vec3(-1, 0, -1));
  EXPECT_EQ(posed_bounds(scene, pose).maximum, glm::vec3(1, 10, 1));
}

TEST(Explosion, LeavesScenesWithoutMeshesAlone) {
  Scene scene;
  const auto node = add_node(scene, {}, {1, 2, 3}, false);
  EXPECT_EQ(place(scene, 1.0f, node), glm::vec3(1, 2, 3));
  EXPECT_TRUE(posed_bounds(scene, rest_pose(scene)).empty());
}

}  // namespace
}  // namespace heliograph::scene
