#include "session/rendering/transparency.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace heliograph::session {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

Pixel put(Pixel over_black, float coverage,
          const std::optional<std::array<float, 3>>& color = std::nullopt) {
  put_background(over_black, {&coverage, 1}, color);
  return over_black;
}

TEST(Transparency, CoverageIsWhatHidesTheBackground) {
  const std::vector<float> white{9, 1.0f, 9, 9, 9, 0.25f, 9, 9, 9, 0.5f, 9, 9};
  const std::vector<float> black{9, 0.0f, 9, 9, 9, 0.25f, 9, 9, 9, 0.25f, 9, 9};
  EXPECT_EQ(coverage_of(white, black), (std::vector<float>{0.0f, 1.0f, 0.75f}));
}

TEST(Transparency, ColorsAreThoseOfTheSurfaceAlone) {
  EXPECT_EQ(put({0, 0, 0, 255}, 0.0f), (Pixel{0, 0, 0, 0}));
  EXPECT_EQ(put({200, 100, 50, 255}, 1.0f), (Pixel{200, 100, 50, 255}));
  // Half of white: 188 is half of 255 in linear light.
  EXPECT_EQ(put({188, 188, 188, 255}, 0.5f), (Pixel{255, 255, 255, 128}));
}

TEST(Transparency, WhatShinesWithoutCoveringIsKept) {
  EXPECT_EQ(put({188, 0, 0, 255}, 0.0f), (Pixel{255, 0, 0, 128}));
}

TEST(Transparency, AColorIsBehindTheSurface) {
  const std::array<float, 3> white{1.0f, 1.0f, 1.0f};
  EXPECT_EQ(put({0, 0, 0, 255}, 0.0f, white), (Pixel{255, 255, 255, 255}));
  EXPECT_EQ(put({10, 20, 30, 255}, 1.0f, white), (Pixel{10, 20, 30, 255}));
  EXPECT_EQ(put({0, 0, 0, 255}, 0.5f, white), (Pixel{188, 188, 188, 255}));
}

}  // namespace
}  // namespace heliograph::session
