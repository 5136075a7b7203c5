#include "tests/support/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace heliograph::test {
namespace {

constexpr double c1 = 6.5025, c2 = 58.5225;

template <typename Value>
render::Frame make_frame(Value value) {
  render::Frame frame;
  frame.width = 40;
  frame.height = 30;
  for (std::uint32_t y = 0; y < frame.height; ++y) {
    for (std::uint32_t x = 0; x < frame.width; ++x) {
      const auto grey = static_cast<std::uint8_t>(value(x, y));
      frame.rgba.insert(frame.rgba.end(), {grey, grey, grey, 255});
    }
  }
  return frame;
}

TEST(Ssim, EqualImagesGiveOne) {
  const auto noise = make_frame([](auto x, auto y) { return (x * 7919 + y * 104729) % 251; });
  EXPECT_NEAR(ssim(noise, noise), 1.0, 1e-12);
}

TEST(Ssim, UniformImagesCompareMeans) {
  const auto a = make_frame([](auto, auto) { return 100; }),
             b = make_frame([](auto, auto) { return 150; });
  EXPECT_NEAR(ssim(a, b), (2.0 * 100 * 150 + c1) / (100.0 * 100 + 150.0 * 150 + c1), 1e-9);
}

// The Gaussian-weighted mean of a checkerboard is its mean within 1e-2.
TEST(Ssim, InvertedCheckerboardIsNegative) {
  const auto a = make_frame([](auto x, auto y) { return (x + y) % 2 ? 140 : 100; });
  const auto b = make_frame([](auto x, auto y) { return (x + y) % 2 ? 100 : 140; });
  EXPECT_NEAR(ssim(a, b), (c2 - 2.0 * 400) / (c2 + 2.0 * 400), 1e-4);
}

TEST(Ssim, HalvedContrastIsAnalytic) {
  const auto a = make_frame([](auto x, auto y) { return (x + y) % 2 ? 140 : 100; });
  const auto b = make_frame([](auto x, auto y) { return (x + y) % 2 ? 130 : 110; });
  EXPECT_NEAR(ssim(a, b), (2.0 * 200 + c2) / (400.0 + 100.0 + c2), 1e-4);
}

TEST(Difference, IsMeanAndMaximumOfColorChannels) {
  render::FloatImage a{2, 1, {0, 0, 0, 1, 1, 2, 3, 1}};
  render::FloatImage b{2, 1, {0, 0, 0, 9, 1, 2, 6, 1}};
  EXPECT_DOUBLE_EQ(difference(a, b).mean, 0.5);
  EXPECT_DOUBLE_EQ(difference(a, b).maximum, 3.0);
  b.rgba[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isinf(difference(a, b).maximum));
}

}  // namespace
}  // namespace heliograph::test
