#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/frame/buffer_list.hpp"

namespace heliograph::render {
namespace {

std::array<int, 3> shown(std::string_view buffer, const std::array<float, 4>& value) {
  const Frame frame = visualise(buffer, {1, 1, {value[0], value[1], value[2], value[3]}});
  EXPECT_EQ(frame.rgba.size(), 4u);
  EXPECT_EQ(frame.rgba[3], 255);
  return {frame.rgba[0], frame.rgba[1], frame.rgba[2]};
}

using Rgb = std::array<int, 3>;

TEST(Visualise, OutputIsUnchanged) {
  EXPECT_EQ(shown("output", {0.0f, 0.5f, 1.0f, 1.0f}), (Rgb{0, 128, 255}));
}

TEST(Visualise, NormalsAreColoredByAxisAndBackgroundIsBlack) {
  EXPECT_EQ(shown("gbuffer.normals", {2, 2, 2, 2}), (Rgb{0, 0, 0})) << "no normal";
  EXPECT_EQ(shown("gbuffer.normals", {0, 0, 0, 0}), (Rgb{128, 128, 255})) << "toward +Z";
  EXPECT_EQ(shown("gbuffer.normals", {1, 0, 1, 0}), (Rgb{255, 128, 128}));
  EXPECT_EQ(shown("gbuffer.normals", {0, 0, 0, 0.1f}), (Rgb{128, 128, 255}));
}

TEST(Visualise, NonFinitePixelsAreBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(shown("hdr", {nan, nan, nan, 1}), (Rgb{0, 0, 0}));
  EXPECT_EQ(shown("output", {nan, 1, -5, 1}), (Rgb{0, 255, 0}));
}

TEST(Visualise, RadianceIsToneMappedBelowWhite) {
  const Rgb one = shown("hdr", {1, 1, 1, 1}), many = shown("hdr", {100, 100, 100, 1});
  EXPECT_EQ(one[0], 188) << "Reinhard's half, encoded";
  EXPECT_GT(many[0], one[0]);
  EXPECT_LT(many[0], 255);
}

TEST(Visualise, ConsecutiveInstanceColorsDiffer) {
  EXPECT_EQ(shown("gbuffer.instance", {0, 0, 0, 1}), (Rgb{0, 0, 0}));
  for (int id = 1; id < 60; ++id) {
    const Rgb a = shown("gbuffer.instance", {static_cast<float>(id), 0, 0, 1});
    const Rgb b = shown("gbuffer.instance", {static_cast<float>(id + 1), 0, 0, 1});
    int distance = 0;
    for (int c = 0; c < 3; ++c) distance += std::abs(a[c] - b[c]);
    EXPECT_GT(distance, 60) << id;
  }
}

TEST(Visualise, MotionIsScaledAndZeroIsGray) {
  FloatImage image{2, 1, {0.01f, 0, 0, 1, 0, 0, 0, 1}};
  const Frame frame = visualise("gbuffer.motion", image);
  EXPECT_EQ(frame.rgba[0], 255);
  EXPECT_EQ(frame.rgba[4], 128);
  EXPECT_EQ(frame.rgba[5], 128);
}

}  // namespace
}  // namespace heliograph::render
