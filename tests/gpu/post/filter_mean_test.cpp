#include "render/passes/post/filter_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{48, 40};
constexpr std::size_t pixels = extent.width * extent.height;
constexpr std::uint32_t samples = 65;
using Texels = std::vector<glm::vec4>;

/// Grey of this luminance; w: the variance of a sample's.
glm::vec4 grey(float light, float variance = 0.0f) {
  return {light, light, light, variance};
}

std::size_t at(std::uint32_t x, std::uint32_t y) {
  return y * extent.width + x;
}

class FilterMean : public testing::Test {
 protected:
  FilterMean() {
    const auto image = [&](const char* name) {
      return rig_.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, Texels(pixels, grey(1.0f)));
    };
    frame_ = image("frame");
    mean_ = image("mean");
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), frame_, mean_);
    filtered_ = render::filter_mean(rig_.plan(), rig_.inputs(), exposure, frame_, mean_);
  }

  render::FloatImage filtered(const Texels& frame, const Texels& mean,
                              std::uint32_t count = samples) {
    rig_.fill(frame_, frame);
    rig_.fill(mean_, mean);
    rig_.set_accumulated(count - 1);
    rig_.run();
    return rig_.read(filtered_);
  }

  /// The mean of samples of this variance around `light`.
  Texels noisy(const Texels& light, float variance) {
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0.0f, std::sqrt(variance / float(samples)));
    Texels mean(pixels);
    for (std::size_t i = 0; i < pixels; ++i) mean[i] = grey(light[i].x + noise(random), variance);
    return mean;
  }

  FrameRig rig_{SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}};
  gpu::ImageRef frame_, mean_, filtered_;
};

double mean_square_error(const render::FloatImage& image, const Texels& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double error = image.rgba[4 * i] - truth[i].x;
    sum += error * error;
  }
  return sum / static_cast<double>(pixels);
}

TEST_F(FilterMean, AveragesNoiseAndTellsWhatIsLeft) {
  const Texels truth(pixels, grey(1.0f));
  const render::FloatImage image = filtered(truth, noisy(truth, 0.5f));
  const double before = 0.5 / samples, after = mean_square_error(image, truth);
  EXPECT_LT(after, before / 6.0);
  double told = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    told += double(image.rgba[4 * i + 3]) * double(image.rgba[4 * i + 3]);
  }
  told /= static_cast<double>(pixels);
  // Weights that follow the noise choose what is alike: it tells a little less than there is.
  EXPECT_GT(told, 0.4 * after);
  EXPECT_LT(told, 2.0 * after);
}

TEST_F(FilterMean, KeepsWhatIsNoNoise) {
  Texels mean(pixels);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x)
      mean[at(x, y)] = grey((x + y) % 2 ? 1.0f : 2.0f);
  }
  const render::FloatImage image = filtered(Texels(pixels, grey(1.5f)), mean);
  for (std::size_t i = 0; i < pixels; ++i) ASSERT_EQ(image.rgba[4 * i], mean[i].x) << i;
}

TEST_F(FilterMean, KeepsEdgesThatTheFrameLacks) {
  Texels truth(pixels);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      truth[at(x, y)] = grey(x < extent.width / 2 ? 0.5f : 1.5f);
    }
  }
  // Its noise is a tenth of the step.
  const render::FloatImage image =
      filtered(Texels(pixels, grey(1.0f)), noisy(truth, 0.01f * float(samples)));
  EXPECT_LT(mean_square_error(image, truth), 0.01 / 3.0);
  const std::uint32_t edge = extent.width / 2;
  for (std::uint32_t y = 4; y + 4 < extent.height; ++y) {
    EXPECT_LT(texel(image, edge - 1, y).x, 0.8f) << y;
    EXPECT_GT(texel(image, edge, y).x, 1.2f) << y;
  }
}

// One bright sample of few pixels must be spread, not lost, or the image gets darker.
TEST_F(FilterMean, SpreadsRareBrightSamples) {
  const float bright = 20.0f;
  Texels mean(pixels, grey(1.0f, 1e-4f));
  const float share = (bright - 1.0f) / float(samples);
  for (std::uint32_t y = 4; y < extent.height; y += 12) {
    for (std::uint32_t x = 4; x < extent.width; x += 12) {
      mean[at(x, y)] = grey(1.0f + share, share * share * float(samples));
    }
  }
  const render::FloatImage image = filtered(Texels(pixels, grey(1.0f)), mean);
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    before += mean[i].x - 1.0f;
    after += image.rgba[4 * i] - 1.0f;
  }
  EXPECT_GT(after, 0.75 * before);
  EXPECT_LT(after, 1.05 * before);
  EXPECT_LT(texel(image, 4, 4).x, 1.0f + 0.5f * share);
}

// Two samples of which one in four finds the light, and which 2x2 pixels share: where a whole patch
// found none, its samples tell of no noise, and the weight of the mean would show a dark spot.
TEST_F(FilterMean, PixelsOfLikeSamplesAreNotFreeOfNoise) {
  constexpr float dark = 1.0f, light = 2.0f;
  std::mt19937 random(5);
  std::bernoulli_distribution found(0.25);
  Texels mean(pixels);
  for (std::uint32_t y = 0; y < extent.height; y += 2) {
    for (std::uint32_t x = 0; x < extent.width; x += 2) {
      const float a = found(random) ? light : dark, b = found(random) ? light : dark;
      const glm::vec4 texel = grey((a + b) / 2.0f, (a - b) * (a - b) / 4.0f);
      for (const std::uint32_t i : {0u, 1u, 2u, 3u}) mean[at(x + i % 2, y + i / 2)] = texel;
    }
  }
  const Texels truth(pixels, grey(0.75f * dark + 0.25f * light));
  const render::FloatImage image = filtered(truth, mean, 3);
  double least = 1.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    least = std::min(least, double(image.rgba[4 * i + 3]));
  }
  // Of two samples it is about .3, averaged over 49 pixels .04; without the surroundings 0.
  EXPECT_GT(least, 0.01);
}

TEST_F(FilterMean, BrokenPixelsDoNotSpread) {
  Texels mean(pixels, grey(3.0f, 0.5f));
  mean[at(12, 10)].y = std::numeric_limits<float>::quiet_NaN();
  mean[at(30, 20)].w = std::numeric_limits<float>::infinity();
  const render::FloatImage image = filtered(Texels(pixels, grey(1.0f)), mean);
  for (const float value : image.rgba) ASSERT_TRUE(std::isfinite(value));
  EXPECT_EQ(texel(image, 12, 10), glm::vec4(1, 1, 1, 0));
  EXPECT_EQ(texel(image, 30, 20), glm::vec4(1, 1, 1, 0));
  EXPECT_NEAR(texel(image, 40, 4).x, 3.0f, 0.01f);
}

TEST_F(FilterMean, LeavesTheMeanAsItIsWhenSwitchedOff) {
  protocol::Settings settings;
  settings.accumulation.filter = false;
  rig_.set_settings(settings);
  const Texels mean = noisy(Texels(pixels, grey(1.0f)), 0.5f);
  const render::FloatImage image = filtered(Texels(pixels, grey(1.0f)), mean);
  for (std::size_t i = 0; i < pixels; ++i) {
    ASSERT_NEAR(image.rgba[4 * i], mean[i].x, mean[i].x * 0x1p-11f) << i;
  }
}

}  // namespace
}  // namespace heliograph::test
