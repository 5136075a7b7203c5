#include "scene/animation/pose.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace heliograph::scene {
namespace {

Channel curve(Property property, Interpolation interpolation, std::uint32_t width,
              std::vector<float> times, std::vector<float> values) {
  return {{interpolation, width, std::move(times), std::move(values)}, 0, property};
}

std::array<float, 4> at(const Channel& channel, float seconds) {
  std::array<float, 4> value{};
  sample(channel, seconds, value.data());
  return value;
}

TEST(Sample, LinearInterpolatesAndClampsAtEnds) {
  const Channel channel =
      curve(Property::translation, Interpolation::linear, 3, {1, 3}, {0, 10, -2, 4, 20, 6});
  EXPECT_EQ(at(channel, 0.0f), (std::array<float, 4>{0, 10, -2, 0})) << "before the first key";
  EXPECT_EQ(at(channel, 1.5f), (std::array<float, 4>{1, 12.5f, 0, 0}));
  EXPECT_EQ(at(channel, 3.0f), (std::array<float, 4>{4, 20, 6, 0}));
  EXPECT_EQ(at(channel, 9.0f), (std::array<float, 4>{4, 20, 6, 0})) << "after the last key";
}

TEST(Sample, StepHoldsUntilNextKey) {
  const Channel channel =
      curve(Property::scale, Interpolation::step, 3, {0, 1}, {1, 1, 1, 2, 3, 4});
  EXPECT_EQ(at(channel, 0.999f), (std::array<float, 4>{1, 1, 1, 0}));
  EXPECT_EQ(at(channel, 1.0f), (std::array<float, 4>{2, 3, 4, 0}));
}

// By hand from glTF 2.0, C.5: at the middle of two seconds, with start 0, end 8, out-tangent 6 and
// in-tangent -2 per second: 0.5*0 + 0.125*2*6 + 0.5*8 - 0.125*2*(-2) = 6.
TEST(Sample, SplineTangentsAreScaledByKeyInterval) {
  const Channel channel =
      curve(Property::weights, Interpolation::cubic_spline, 1, {0, 2}, {99, 0, 6, -2, 8, 99});
  EXPECT_FLOAT_EQ(at(channel, 1.0f)[0], 6.0f);
  EXPECT_FLOAT_EQ(at(channel, 0.0f)[0], 0.0f);
  EXPECT_FLOAT_EQ(at(channel, 2.0f)[0], 8.0f);
  // The slope at the start is the out-tangent itself.
  EXPECT_NEAR(at(channel, 0.001f)[0] / 0.001f, 6.0f, 0.02f);
  EXPECT_FLOAT_EQ(at(channel, 7.0f)[0], 8.0f) << "beyond the ends the value is constant";
}

float angle_about_y(const std::array<float, 4>& xyzw) {
  return 2.0f * std::atan2(xyzw[1], xyzw[3]);
}

TEST(Sample, RotationsTakeShortestArcAtConstantSpeed) {
  const float half = std::numbers::pi_v<float> / 4.0f;  // of a quarter turn about y
  // The second key is the negated quaternion of the same rotation: naive interpolation takes the
  // long way.
  const Channel channel = curve(Property::rotation, Interpolation::linear, 4, {0, 1},
                                {0, 0, 0, 1, 0, -std::sin(half), 0, -std::cos(half)});
  for (const float time : {0.1f, 0.25f, 0.5f, 0.9f}) {
    const auto value = at(channel, time);
    EXPECT_NEAR(angle_about_y(value), 2.0f * half * time, 1e-5f);
    EXPECT_NEAR(value[1] * value[1] + value[3] * value[3], 1.0f, 1e-6f);
  }
}

TEST(Sample, RotationSplinesAreNormalized) {
  const Channel channel =
      curve(Property::rotation, Interpolation::cubic_spline, 4, {0, 1},
            {0, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  const auto value = at(channel, 0.4f);
  float length = 0.0f;
  for (const float part : value) length += part * part;
  EXPECT_NEAR(length, 1.0f, 1e-6f);
}

TEST(Sample, ZeroQuaternionIsIdentity) {
  const Channel channel = curve(Property::rotation, Interpolation::linear, 4, {0}, {0, 0, 0, 0});
  EXPECT_EQ(at(channel, 0.0f), (std::array<float, 4>{0, 0, 0, 1}));
}

/// A rotating parent with a child at one metre, and a static node.
Scene animated_scene() {
  Scene scene;
  Transform child;
  child.translation = {1, 0, 0};
  scene.nodes = {{.name = "parent", .transform = Transform{}},
                 {.name = "child",
                  .parent = 0,
                  .local = child.matrix(),
                  .world = child.matrix(),
                  .transform = child},
                 {.name = "still", .weights = {0.25f}}};
  const float half = std::numbers::pi_v<float> / 4.0f;
  Clip clip{"turn", 2.0f, {}};
  clip.channels.push_back(curve(Property::rotation, Interpolation::linear, 4, {0, 2},
                                {0, 0, 0, 1, 0, std::sin(half), 0, std::cos(half)}));
  scene.clips.push_back(clip);
  return scene;
}

glm::vec3 position_of(const Pose& pose, std::size_t node) {
  return glm::vec3(pose.worlds[node][3]);
}

TEST(Evaluate, ChildrenFollowParents) {
  const Scene scene = animated_scene();
  Pose pose = rest_pose(scene);
  evaluate(scene, *find_clip(scene, "turn"), 2.0, pose);
  EXPECT_LE(glm::distance(position_of(pose, 1), {0, 0, -1}), 1e-6f) << "a quarter turn about y";
  EXPECT_EQ(pose.worlds[2], glm::mat4(1.0f));
  EXPECT_EQ(pose.weights[2], std::vector<float>{0.25f});
}

TEST(Evaluate, LoopsAndIncludesEndTime) {
  const Scene scene = animated_scene();
  Pose once = rest_pose(scene), again = rest_pose(scene);
  evaluate(scene, scene.clips[0], 0.5, once);
  evaluate(scene, scene.clips[0], 4.5, again);
  EXPECT_EQ(once.worlds[1], again.worlds[1]);
  evaluate(scene, scene.clips[0], -1.0, again);
  EXPECT_EQ(again.worlds[1], scene.nodes[1].world);
  // Long playback loses no precision: the time is wrapped in double.
  evaluate(scene, scene.clips[0], 2.0e6 + 0.5, again);
  EXPECT_LE(glm::distance(position_of(again, 1), position_of(once, 1)), 1e-5f);
}

TEST(Evaluate, OtherClipStartsFromDefaultPose) {
  Scene scene = animated_scene();
  Clip other{"lift", 1.0f, {}};
  other.channels.push_back(curve(Property::translation, Interpolation::linear, 3, {0}, {0, 5, 0}));
  scene.clips.push_back(other);
  Pose pose = rest_pose(scene);
  evaluate(scene, scene.clips[0], 2.0, pose);
  evaluate(scene, scene.clips[1], 0.0, pose);
  EXPECT_EQ(position_of(pose, 1), glm::vec3(1, 5, 0));
  EXPECT_EQ(find_clip(scene, "walk"), nullptr);
}

TEST(MovableNodes, AreThoseBelowAnyAnimatedNode) {
  Scene scene = animated_scene();
  EXPECT_EQ(movable_nodes(scene), (std::vector<bool>{true, true, false}));
  // Morph weights deform a mesh, but move no node.
  scene.clips[0].channels = {curve(Property::weights, Interpolation::linear, 1, {0}, {1})};
  EXPECT_EQ(movable_nodes(scene), std::vector<bool>(3));
  Channel lift = curve(Property::translation, Interpolation::linear, 3, {0}, {0, 5, 0});
  lift.node = 1;
  scene.clips.push_back({"lift", 1.0f, {lift}});
  EXPECT_EQ(movable_nodes(scene), (std::vector<bool>{false, true, false}));
}

}  // namespace
}  // namespace heliograph::scene
