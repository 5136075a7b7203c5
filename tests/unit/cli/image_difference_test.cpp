#include "cli/compare/image_difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

namespace heliograph::cli {
namespace {

ComparedImage uniform(std::array<std::uint8_t, 3> color, std::uint32_t size = 32) {
  ComparedImage image{size, size, {}};
  for (std::uint32_t i = 0; i < size * size; ++i) {
    image.rgba.insert(image.rgba.end(), {color[0], color[1], color[2], 255});
  }
  return image;
}

ComparedImage noisy(ComparedImage image, int amplitude, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> offset(-amplitude, amplitude);
  for (std::uint8_t& value : image.rgba) {
    value = static_cast<std::uint8_t>(std::clamp(value + offset(random), 0, 255));
  }
  return image;
}

double mean_flip(const ComparedImage& a, const ComparedImage& b) {
  double sum = 0.0;
  const auto values = flip(a, b);
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

TEST(StructuralSimilarity, IsOneForEqualImagesAndFallsWithNoise) {
  const ComparedImage image = noisy(uniform({120, 90, 60}), 60, 1);
  EXPECT_DOUBLE_EQ(structural_similarity(image, image), 1.0);
  const double slight = structural_similarity(image, noisy(image, 5, 2));
  const double strong = structural_similarity(image, noisy(image, 60, 2));
  EXPECT_LT(slight, 1.0);
  EXPECT_GT(slight, 0.9);
  EXPECT_LT(strong, 0.8);
}

TEST(StructuralSimilarity, OfUniformImagesIsThatOfTheirMeans) {
  const double a = 100.0, b = 200.0, c1 = 2.55 * 2.55;
  EXPECT_NEAR(structural_similarity(uniform({100, 100, 100}), uniform({200, 200, 200})),
              (2 * a * b + c1) / (a * a + b * b + c1), 1e-6);
  // Smaller than a window.
  EXPECT_DOUBLE_EQ(structural_similarity(uniform({9, 9, 9}, 4), uniform({9, 9, 9}, 4)), 1.0);
}

TEST(Flip, IsZeroForEqualImages) {
  const ComparedImage image = noisy(uniform({120, 90, 60}), 60, 1);
  const auto values = flip(image, image);
  EXPECT_EQ(*std::ranges::max_element(values), 0.0f);
}

TEST(Flip, OfBlackAndWhiteIsThatOfThePaper) {
  // Lightness differs by 100; 100^.7 lies beyond the split at .4 of the most of green and blue.
  EXPECT_NEAR(mean_flip(uniform({0, 0, 0}), uniform({255, 255, 255})), 0.967, 2e-3);
  // The largest distance that there is.
  EXPECT_NEAR(mean_flip(uniform({0, 255, 0}), uniform({0, 0, 255})), 1.0, 1e-3);
}

TEST(Flip, APointIsSeenThatABlurOfItsLightIsNot) {
  const ComparedImage gray = uniform({128, 128, 128});
  ComparedImage point = gray;
  const std::size_t middle = 4 * (16 * 32 + 16);
  std::fill_n(point.rgba.begin() + static_cast<std::ptrdiff_t>(middle), 3, std::uint8_t{255});
  const auto values = flip(gray, point);
  EXPECT_GT(values[middle / 4], 0.2f);
  EXPECT_EQ(values[0], 0.0f) << "far from it";
  EXPECT_LT(mean_flip(gray, uniform({129, 129, 129})), 0.05);
}

}  // namespace
}  // namespace heliograph::cli
