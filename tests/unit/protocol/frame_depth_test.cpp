#include "protocol/messages/frame_depth.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace heliograph::protocol {
namespace {

TEST(FrameDepth, DifferencesOfAPlaneAreZeroInside) {
  constexpr std::size_t width = 5, height = 4;
  std::vector<std::uint16_t> samples;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      samples.push_back(static_cast<std::uint16_t>(60000 - 300 * x + 900 * y));
    }
  }
  const std::vector<std::uint8_t> bytes = depth_differences(samples, width);
  ASSERT_EQ(bytes.size(), 2 * samples.size());
  for (std::size_t y = 1; y < height; ++y) {
    for (std::size_t x = 1; x < width; ++x) {
      EXPECT_EQ(bytes[y * width + x], 0);
      EXPECT_EQ(bytes[samples.size() + y * width + x], 0);
    }
  }
}

TEST(FrameDepth, DifferencesHaveTheirSignInTheLowestBit) {
  const std::vector<std::uint16_t> samples{0x0203, 0x0201, 0};
  // 515 to the left of nothing, then -2, then -513.
  EXPECT_EQ(depth_differences(samples, 3),
            (std::vector<std::uint8_t>{0x06, 0x03, 0x01, 0x04, 0x00, 0x04}));
}

TEST(FrameDepth, LayoutIsTheDocumentedOne) {
  const FrameDepth depth{.width = 0x0102,
                         .height = 3,
                         .nearest = 0.5f,
                         .eye = {1.0f, 2.0f, 3.0f},
                         .target = {},
                         .up = {0.0f, 1.0f, 0.0f},
                         .vertical_fov = 45.0f};
  const std::vector<std::uint8_t> bytes = encode_frame_depth(depth, std::vector<std::uint8_t>{9});
  ASSERT_EQ(bytes.size(), frame_depth_bytes + 1);
  const auto float_at = [&](std::size_t offset) {
    float value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  EXPECT_EQ(bytes[0], 0x02);
  EXPECT_EQ(bytes[1], 0x01);
  EXPECT_EQ(bytes[2], 3);
  EXPECT_EQ(float_at(4), 0.5f);
  EXPECT_EQ(float_at(12), 2.0f);
  EXPECT_EQ(float_at(36), 1.0f);
  EXPECT_EQ(float_at(44), 45.0f);
  EXPECT_EQ(bytes[48], 1);
  EXPECT_EQ(bytes.back(), 9);
}

}  // namespace
}  // namespace heliograph::protocol
