#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/gpu/denoise/atrous_field.hpp"

// A blur by halves of iterations holds 16 bits a channel between its passes, and reads a packed
// guide: its results against those of a reference in double that rounds nothing.

namespace heliograph::test {
namespace {

constexpr auto separable = protocol::BlurKernel::separable;

std::vector<glm::dvec4> blurred_by_halves(FilterInput in, const shared::AtrousConstants& given,
                                          bool specular, int iterations, const FrameRig& rig) {
  const float footprint =
      2.0f * std::abs(rig.constants().unproject.y) / static_cast<float>(field_height);
  std::vector<glm::dvec4> result;
  for (int pass = 0; pass < 2 * iterations; ++pass) {
    shared::AtrousConstants constants = given;
    constants.level = given.level + pass / 2;
    const bool across = (rig.constants().sample_index + static_cast<std::uint32_t>(pass / 2)) % 2 ==
                        static_cast<std::uint32_t>(pass % 2);
    constants.columns = across ? 2 : 0;
    constants.rows = across ? 0 : 2;
    result = AtrousReference(in, constants, specular, footprint, Weights::cheap).run();
    for (std::size_t i = 0; i < field_pixels; ++i) in.signal[i] = glm::vec4(result[i]);
  }
  return result;
}

class AtrousHalves : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Signals, AtrousHalves, testing::Bool(), [](const auto& instance) {
  return instance.param ? "specular" : "visibility";
});

TEST_P(AtrousHalves, MatchReferenceThatRoundsNothing) {
  for (const float start : {2.0f, -1.0f}) {
    for (const int iterations : {1, 3, 6}) {
      const FilterInput in(7);
      shared::AtrousConstants constants = plain_constants();
      constants.start_threshold = start;
      FilterRig filter(in, constants, GetParam(), iterations, separable);
      const render::FloatImage got = filter.run();
      const auto expected = blurred_by_halves(in, constants, GetParam(), iterations, filter.rig);
      double mean_off = 0.0;
      for (std::size_t i = 0; i < field_pixels; ++i) {
        for (int k = 0; k < 4; ++k) {
          const double off = std::abs(got.rgba[4 * i + k] - expected[i][k]);
          // Signals of 0 to 1 are off by a few steps of half floats.
          ASSERT_LT(off, 2e-3) << "pixel " << i << " channel " << k << ", " << iterations
                               << " iterations, start " << start;
          mean_off += off / (4.0 * field_pixels);
        }
      }
      EXPECT_LT(mean_off, 2e-4) << iterations << " iterations, start " << start;
    }
  }
}

// Stores that round toward zero lose 0.2 to 0.3 % in six iterations.
TEST_P(AtrousHalves, KeepBrightnessOverManyIterations) {
  for (const std::uint32_t seed : {7u, 8u, 9u}) {
    for (const float scale : {0.02f, 1.0f, 3000.0f}) {
      FilterInput in(seed);
      for (glm::vec4& value : in.signal) value *= glm::vec4(scale, scale, scale, scale);
      FilterRig filter(in, plain_constants(), GetParam(), 6, separable);
      const render::FloatImage got = filter.run();
      const auto expected = blurred_by_halves(in, plain_constants(), GetParam(), 6, filter.rig);
      double sum = 0.0, expected_sum = 0.0;
      for (std::size_t i = 0; i < field_pixels; ++i) {
        sum += got.rgba[4 * i] + got.rgba[4 * i + 1];
        expected_sum += expected[i].x + expected[i].y;
      }
      EXPECT_NEAR(sum / expected_sum, 1.0, 2e-4) << "seed " << seed << ", times " << scale;
    }
  }
}

TEST_P(AtrousHalves, ChangeConstantSignalsByOneRoundingAtMost) {
  for (const float level : {3e-4f, 0.123f, 0.7771f, 1.4142f, 99.99f, 60001.0f}) {
    FilterInput in(1);
    for (glm::vec4& value : in.signal) value = glm::vec4(level);
    FilterRig filter(in, plain_constants(), GetParam(), 6, separable);
    const render::FloatImage got = filter.run();
    for (std::size_t i = 0; i < field_pixels; ++i) {
      ASSERT_NEAR(got.rgba[4 * i] / level, 1.0f, 1.0f / 2048.0f + 1e-5f) << i << ", " << level;
    }
  }
}

TEST_P(AtrousHalves, BrightSignalsAndGreatVariancesStayFinite) {
  const bool specular = GetParam();
  for (const float variance : {1e9f, 1e12f}) {
    FilterInput in(1);
    for (glm::vec4& value : in.signal) {
      value = glm::vec4(6e4f, 6e4f, specular ? 6e4f : variance, variance);
    }
    FilterRig filter(in, plain_constants(), specular, 3, separable);
    const render::FloatImage got = filter.run();
    for (std::size_t i = 0; i < field_pixels; ++i) {
      ASSERT_NEAR(got.rgba[4 * i], 6e4f, 60.0f) << i;
      ASSERT_NEAR(got.rgba[4 * i + 1], 6e4f, 60.0f) << i;
      ASSERT_TRUE(std::isfinite(got.rgba[4 * i + 3])) << i;
      ASSERT_GT(got.rgba[4 * i + 3], 0.0f) << i;
      ASSERT_LE(got.rgba[4 * i + 3], 1.001f * variance) << i;
    }
  }
}

// What lies beyond the range of halves is the largest of them.
TEST_P(AtrousHalves, BoundSignalsBeyondTheRange) {
  FilterInput in(1);
  for (glm::vec4& value : in.signal) value = glm::vec4(1e7f);
  FilterRig filter(in, plain_constants(), GetParam(), 2, separable);
  const render::FloatImage got = filter.run();
  for (std::size_t i = 0; i < field_pixels; ++i) {
    ASSERT_NEAR(got.rgba[4 * i], shared::largest_half, 1.0f) << i;
  }
}

TEST_P(AtrousHalves, FeedBackAndReturnWholeFloats) {
  for (const int fed_back : {0, 1, 2}) {
    const FilterInput in(7);
    FilterRig filter(in, plain_constants(), GetParam(), 3, separable, fed_back);
    const render::FloatImage got = filter.run();
    const auto format = [&](gpu::ImageRef image) {
      return filter.rig.plan().get(image).desc().format;
    };
    EXPECT_EQ(format(filter.kept), render::formats::four_floats) << fed_back;
    EXPECT_EQ(format(filter.filtered), render::formats::four_floats) << fed_back;
    const auto expected = blurred_by_halves(in, plain_constants(), GetParam(), 3, filter.rig);
    for (std::size_t i = 0; i < field_pixels; ++i) {
      ASSERT_NEAR(got.rgba[4 * i], expected[i].x, 2e-3) << i << ", fed back " << fed_back;
    }
  }
}

}  // namespace
}  // namespace heliograph::test
