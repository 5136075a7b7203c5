#include "cli/render/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

namespace heliograph::cli {
namespace {

constexpr std::uint32_t width = 96;
constexpr std::uint32_t height = 64;

/// Smooth shades, an edge and a texture.
std::vector<float> true_image() {
  std::vector<float> image;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double texture = x > width / 2 ? 40.0 * std::sin(0.7 * x) * std::sin(0.5 * y) : 0.0;
      image.push_back(static_cast<float>(120.0 + 0.5 * y + texture + (x > 70 ? 30.0 : 0.0)));
    }
  }
  return image;
}

std::vector<std::uint8_t> to_rgba(const std::vector<double>& sum, int samples) {
  std::vector<std::uint8_t> rgba;
  for (const double value : sum) {
    const auto level =
        static_cast<std::uint8_t>(std::clamp(std::lround(value / samples), 0l, 255l));
    rgba.insert(rgba.end(), {level, level, level, 255});
  }
  return rgba;
}

/// The structural similarity itself, with the windows of the estimate.
double similarity(const std::vector<float>& a, const std::vector<std::uint8_t>& rgba) {
  constexpr double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
  double sum = 0.0;
  int windows = 0;
  for (std::uint32_t top = 0; top + 8 <= height; top += 4) {
    for (std::uint32_t left = 0; left + 8 <= width; left += 4) {
      double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      for (std::uint32_t i = 0; i < 64; ++i) {
        const std::size_t pixel = (top + i / 8) * width + left + i % 8;
        const double u = a[pixel], v = rgba[4 * pixel];
        sa += u, sb += v, saa += u * u, sbb += v * v, sab += u * v;
      }
      const double ma = sa / 64, mb = sb / 64;
      const double va = saa / 64 - ma * ma, vb = sbb / 64 - mb * mb, cov = sab / 64 - ma * mb;
      sum += (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
      ++windows;
    }
  }
  return sum / windows;
}

TEST(Quality, TheEstimateIsTheSimilarityToTheTruth) {
  const std::vector<float> truth = true_image();
  std::vector<double> sum(truth.size());
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 30.0);
  QualityEstimate estimate;
  double before = 0.0;  // of half of the samples
  int compared = 0;
  for (int samples = 1; samples <= 256; ++samples) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += truth[i] + noise(random);
    if (!estimate.wants(static_cast<std::uint32_t>(samples))) continue;
    const auto rgba = to_rgba(sum, samples);
    const auto expected = estimate.add(rgba, width, static_cast<std::uint32_t>(samples));
    const double similar = similarity(truth, rgba);
    const double half = std::exchange(before, similar);
    if (!expected) continue;
    // Noise above the contrast hides how much of the contrast there is.
    const double tolerance = *expected > 0.8 ? 0.01 : 0.05;
    EXPECT_NEAR(*expected, similar, tolerance) << samples << " samples";
    if (half > 0.8) {
      EXPECT_NEAR(estimate.half(), half, 0.01) << samples / 2 << " samples";
    }
    ++compared;
  }
  EXPECT_EQ(compared, 8) << "at 2, 4, 8 ... 256 samples";
}

TEST(Quality, ImagesThatDoNotDifferAreConverged) {
  const std::vector<float> image = true_image();
  EXPECT_DOUBLE_EQ(expected_similarity(image, image, width), 1.0);
  const std::vector<float> tiny(9, 3.0f);
  EXPECT_DOUBLE_EQ(expected_similarity(tiny, tiny, 3), 1.0) << "smaller than a window";
}

TEST(Quality, OnlyDoublingsAreCompared) {
  const std::vector<std::uint8_t> black(std::size_t{4} * width * height);
  QualityEstimate estimate;
  EXPECT_FALSE(estimate.add(black, width, 3));
  EXPECT_FALSE(estimate.wants(5));
  EXPECT_TRUE(estimate.wants(6));
  EXPECT_FALSE(estimate.add(black, width, 7));
  EXPECT_TRUE(estimate.add(black, width, 14));
}

TEST(Quality, FramesTakeTheHalfThatWouldHaveDoneUntilTheNextEstimate) {
  SampleForecast forecast;
  EXPECT_FALSE(forecast.next());
  forecast.add(8, false);
  EXPECT_FALSE(forecast.next()) << "eight samples were needed";
  forecast.add(8, true);
  for (int frame = 0; frame < 5; ++frame) EXPECT_EQ(forecast.next(), 4u);
  EXPECT_FALSE(forecast.next());
}

}  // namespace
}  // namespace heliograph::cli
