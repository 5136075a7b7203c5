#include "scene/animation/tracks.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {
namespace {

using Numbers = std::vector<float>;

/// Of single numbers, with keys at 0 and 2 seconds.
Track track_of(PointedProperty property, std::uint32_t object, Numbers values,
               Interpolation interpolation = Interpolation::linear) {
  return {{interpolation, 1, {0.0f, 2.0f}, std::move(values)}, property, object};
}

Clip clip_of(std::vector<Track> tracks) {
  return {.name = "clip", .duration = 2.0f, .channels = {}, .tracks = std::move(tracks)};
}

TEST(Tracks, EveryInterpolationGivesValuesInTheRangeOfTheProperty) {
  // Halfway a spline with the out-tangent 8 per second from 0 to 1 is at 0.5 + 0.125 * 2 * 8.
  const struct {
    Interpolation interpolation;
    Numbers values;
    float halfway;
  } cases[] = {{Interpolation::step, {0.25f, 0.75f}, 0.25f},
               {Interpolation::linear, {0.25f, 0.75f}, 0.5f},
               {Interpolation::cubic_spline, {0, 0.25f, 0, 0, 0.75f, 0}, 0.5f},
               {Interpolation::cubic_spline, {0, 0, 8, 0, 1, 0}, 1.0f},
               {Interpolation::linear, {-4, 1}, 0.0f}};
  for (const auto& [interpolation, values, halfway] : cases) {
    const Clip clip = clip_of({track_of(PointedProperty::roughness, 0, values, interpolation)});
    EXPECT_FLOAT_EQ(value_of(clip.tracks[0], moment_of(clip, 1.0))[0], halfway);
    EXPECT_FLOAT_EQ(value_of(clip.tracks[0], moment_of(clip, 5.0))[0], halfway) << "clips loop";
  }
}

TEST(Tracks, WhatOverflowsStaysInRange) {
  constexpr float most = std::numeric_limits<float>::max();
  const auto halfway = [](const Numbers& values) {
    return value_of(track_of(PointedProperty::roughness, 0, values, Interpolation::cubic_spline),
                    1.0f)[0];
  };
  EXPECT_EQ(halfway({0, 0, most, -most, 0, 0}), 1.0f);
  EXPECT_EQ(halfway({0, 0, most, most, 0, 0}), 0.0f) << "no number";
}

TEST(Tracks, AnIndexOfRefractionIsZeroOrOneAndMore) {
  const Track track = track_of(PointedProperty::ior, 0, {0.0f, 1.6f});
  EXPECT_EQ(value_of(track, 0.0f)[0], 0.0f);
  EXPECT_EQ(value_of(track, 0.5f)[0], 1.0f);
  EXPECT_FLOAT_EQ(value_of(track, 2.0f)[0], 1.6f);
}

TEST(Tracks, DistancesThatEndAreNotInfinite) {
  for (const auto property :
       {PointedProperty::light_range, PointedProperty::attenuation_distance}) {
    EXPECT_GT(value_of(track_of(property, 0, {1.0f, 0.0f}), 2.0f)[0], 0.0f) << "0 is infinite";
  }
}

TEST(Tracks, HiddenNodesHideWhatIsBelow) {
  Scene scene;
  scene.nodes = {{.name = "above"}, {.name = "below", .parent = 0}, {.name = "other"}};
  EXPECT_FALSE(has_tracks(scene));
  EXPECT_TRUE(shown_nodes(scene, nullptr, 0.0).empty()) << "all are";
  scene.clips = {clip_of({track_of(PointedProperty::visible, 0, {0, 1}, Interpolation::step)}),
                 clip_of({track_of(PointedProperty::visible, 1, {1, 0}, Interpolation::step)})};
  EXPECT_TRUE(has_tracks(scene));
  EXPECT_EQ(shown_nodes(scene, &scene.clips[0], 1.0), (std::vector<bool>{false, false, true}));
  EXPECT_TRUE(shown_nodes(scene, &scene.clips[0], 2.0).empty());
  EXPECT_EQ(shown_nodes(scene, &scene.clips[1], 2.0), (std::vector<bool>{true, false, true}));
  scene.nodes[0].visible = false;
  EXPECT_EQ(shown_nodes(scene, nullptr, 2.0), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(shown_nodes(scene, &scene.clips[1], 0.0), (std::vector<bool>{false, false, true}));
}

TEST(Tracks, ClipsChangeTheLensesOfTheFilesCameras) {
  constexpr float right_angle = std::numbers::pi_v<float> / 2.0f;
  Scene scene;
  scene.nodes = {{.name = "tripod"}};
  scene.clips = {
      clip_of({track_of(PointedProperty::vertical_fov, 3, {right_angle / 2.0f, right_angle})}),
      clip_of({track_of(PointedProperty::orthographic_height, 4, {1, 3})})};
  Camera perspective;
  perspective.node = 0;
  perspective.number = 3;
  Camera flat = perspective;
  flat.number = 4;
  flat.orthographic_height = 1.0f;
  EXPECT_TRUE(carries(scene, scene.clips[0], perspective));
  EXPECT_FALSE(carries(scene, scene.clips[0], flat));
  EXPECT_NEAR(camera_at(scene, perspective, &scene.clips[0], 1.0).vertical_fov, 67.5f, 1e-3f);
  EXPECT_EQ(camera_at(scene, perspective, nullptr, 1.0).vertical_fov, perspective.vertical_fov);
  EXPECT_FLOAT_EQ(camera_at(scene, flat, &scene.clips[1], 1.0).orthographic_height, 4.0f);
  const Clip mirrored = clip_of({track_of(PointedProperty::orthographic_height, 4, {-2, -2})});
  EXPECT_FLOAT_EQ(camera_at(scene, flat, &mirrored, 0.0).orthographic_height, 4.0f)
      << "as the importer reads it";
  perspective.node.reset();
  EXPECT_FALSE(carries(scene, scene.clips[0], perspective)) << "it is none of the file's";
}

}  // namespace
}  // namespace heliograph::scene
