#include "render/passes/post/mean_weight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/passes/post/filter_mean.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{24, 20};
constexpr std::size_t pixels = extent.width * extent.height;
using Texels = std::vector<glm::vec4>;

/// Grey of this luminance; w: the variance of a sample's.
glm::vec4 grey(float light, float variance = 0.0f) {
  return {light, light, light, variance};
}

class MeanWeightTest : public testing::Test {
 protected:
  MeanWeightTest() {
    const auto image = [&](const char* name) {
      return rig_.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, Texels(pixels, grey(1.0f)));
    };
    frame_ = image("frame");
    mean_ = image("mean");
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), frame_, mean_);
    rig_.set_settings(unfiltered());
    filtered_ = render::filter_mean(rig_.plan(), rig_.inputs(), exposure, frame_, mean_);
    weight_ = render::weigh_mean(rig_.plan(), rig_.inputs(), exposure, frame_, filtered_);
  }

  static protocol::Settings unfiltered() {
    protocol::Settings settings;
    settings.accumulation.filter = false;
    return settings;
  }

  /// The weights with `samples` samples in the mean.
  render::FloatImage weights(const Texels& frame, const Texels& mean, std::uint32_t samples) {
    rig_.fill(frame_, frame);
    rig_.fill(mean_, mean);
    rig_.set_accumulated(samples - 1);
    rig_.run();
    return rig_.read(weight_);
  }
  float weight(float frame, float mean, float variance, std::uint32_t samples) {
    EXPECT_FALSE(uniform_weight(samples));
    const auto all =
        weights(Texels(pixels, grey(frame)), Texels(pixels, grey(mean, variance)), samples);
    EXPECT_EQ(texel(all, 0, 0).x, texel(all, 12, 9).x) << "at the border as inside";
    return texel(all, 12, 9).x;
  }

  /// Of all pixels, with `samples` samples in the mean.
  std::optional<float> uniform_weight(std::uint32_t samples) {
    rig_.set_accumulated(samples - 1);
    return render::uniform_mean_weight(rig_.inputs());
  }

  FrameRig rig_{SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}};
  gpu::ImageRef frame_, mean_, filtered_, weight_;
};

// Derivation: of frame and mean with independent errors, least squared error is where the frame
// weighs v / E[d^2], v being the variance of the mean and d their difference.
TEST_F(MeanWeightTest, IsOneLessTheNoisePartOfTheDifference) {
  // Variance of the mean of 11 samples: 1/10 of one sample's, and 2/10 more for so few.
  // The deviation is a half float: its square is right to 2^-10.
  EXPECT_NEAR(weight(2.0f, 3.0f, 1.0f, 11), 1.0f - 0.12f, 0.12f * 0x1p-10f);
  EXPECT_NEAR(weight(2.0f, 1.5f, 1.0f, 11), 1.0f - 0.12f / 0.25f, 0.48f * 0x1p-10f);
  EXPECT_NEAR(weight(2.0f, 3.0f, 1.0f, 1001), 1.0f - 0.001002f, 1e-5f);
}

TEST_F(MeanWeightTest, DifferencesWithinNoiseShowTheFrame) {
  EXPECT_EQ(weight(2.0f, 2.3f, 1.0f, 11), 0.0f);
  EXPECT_EQ(weight(2.0f, 2.0f, 0.0f, 500), 0.0f);
}

TEST_F(MeanWeightTest, OneSampleTellsNoVariance) {
  EXPECT_EQ(uniform_weight(1), 0.0f);
  EXPECT_FALSE(uniform_weight(2));
}

TEST_F(MeanWeightTest, IsNotWrittenWhereAllPixelsHaveTheSame) {
  const auto runs = [&](std::uint32_t samples) {
    rig_.set_accumulated(samples - 1);
    rig_.run();
    const auto& passes = rig_.plan().timings();
    const auto pass = std::ranges::find(passes, "mean_weight", &gpu::PassTiming::name);
    EXPECT_NE(pass, passes.end());
    return pass->milliseconds >= 0.0f;
  };
  EXPECT_FALSE(runs(1));
  EXPECT_TRUE(runs(2));
  protocol::Settings settings = unfiltered();
  settings.accumulation.by_noise = false;
  rig_.set_settings(settings);
  EXPECT_FALSE(runs(2));
}

TEST_F(MeanWeightTest, ConvergesToTheMeanWhereTheFrameIsWrong) {
  float before = 0.0f;
  for (const std::uint32_t samples : {4u, 16u, 64u, 256u, 4096u, 100000u}) {
    const float now = weight(2.0f, 2.5f, 0.5f, samples);
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(before, 0.9999f);
}

TEST_F(MeanWeightTest, EachRegionFollowsItsOwnNoise) {
  Texels frame(pixels, grey(1.0f)), mean(pixels, grey(1.0f, 0.5f));
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = extent.width / 2; x < extent.width; ++x) {
      mean[y * extent.width + x].x = mean[y * extent.width + x].y = 2.0f;
    }
  }
  const render::FloatImage all = weights(frame, mean, 65);
  for (std::uint32_t x = 0; x < extent.width; ++x) {
    const float found = texel(all, x, 10).x;
    if (x + 3 < extent.width / 2) {
      EXPECT_EQ(found, 0.0f) << x;
    } else if (x >= extent.width / 2 + 3) {
      EXPECT_GT(found, 0.98f) << x;
    }
  }
}

TEST_F(MeanWeightTest, BrokenPixelsShowTheFrame) {
  Texels frame(pixels, grey(1.0f)), mean(pixels, grey(3.0f, 0.5f));
  mean[10 * extent.width + 12].y = std::numeric_limits<float>::quiet_NaN();
  const render::FloatImage all = weights(frame, mean, 65);
  for (const float value : all.rgba) EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(texel(rig_.read(filtered_), 12, 10), glm::vec4(1, 1, 1, 0));
  EXPECT_GT(texel(all, 2, 2).x, 0.9f);
}

TEST_F(MeanWeightTest, FollowsTheNumberOfSamplesWithoutNoise) {
  protocol::Settings settings = unfiltered();
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 8;
  rig_.set_settings(settings);
  EXPECT_FLOAT_EQ(uniform_weight(9).value(), 0.5f);
  EXPECT_FLOAT_EQ(uniform_weight(25).value(), 0.75f);
  EXPECT_EQ(uniform_weight(1), 0.0f);
  settings.accumulation.by_noise = true;
  settings.accumulation.blend_samples = 0;
  rig_.set_settings(settings);
  EXPECT_EQ(uniform_weight(1), 1.0f) << "the mean alone";
}

}  // namespace
}  // namespace heliograph::test
