#include "render/passes/denoise/atrous.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/passes/denoise/denoise_constants.hpp"
#include "tests/gpu/denoise/atrous_field.hpp"

namespace heliograph::test {
namespace {

constexpr int width = field_width, height = field_height;
constexpr std::size_t pixels = field_pixels;

class Atrous : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Signals, Atrous, testing::Bool(), [](const auto& instance) {
  return instance.param ? "specular" : "visibility";
});

TEST_P(Atrous, MatchesReferenceOnRandomInput) {
  for (const float start : {2.0f, -1.0f}) {
    for (const std::uint32_t flags : {0u, shared::atrous_variance_prefilter}) {
      const FilterInput in(7);
      shared::AtrousConstants constants = plain_constants();
      constants.start_threshold = start;
      constants.flags = flags;
      FilterRig filter(in, constants, GetParam());
      const render::FloatImage got = filter.run();
      constants.columns = constants.rows = 2;
      const float footprint =
          2.0f * std::abs(filter.rig.constants().unproject.y) / static_cast<float>(height);
      const auto reference = [&](Weights weights) {
        return AtrousReference(in, constants, GetParam(), footprint, weights).run();
      };
      const auto expected = reference(Weights::cheap), stated = reference(Weights::stated);
      double mean_off = 0.0;
      for (std::size_t i = 0; i < pixels; ++i) {
        for (int k = 0; k < 4; ++k) {
          const double value = got.rgba[4 * i + k];
          ASSERT_NEAR(value, expected[i][k], 2e-4 * std::abs(expected[i][k]) + 2e-5)
              << "pixel " << i << " channel " << k << " start " << start;
          ASSERT_NEAR(value, stated[i][k], 0.02) << "pixel " << i << " channel " << k;
          mean_off += std::abs(value - stated[i][k]) / (4.0 * pixels);
        }
      }
      EXPECT_LT(mean_off, 2e-3) << "cheap weights change nothing that shows";
    }
  }
}

TEST_P(Atrous, ConstantSignalIsUnchanged) {
  FilterInput in(1);
  for (auto& value : in.signal) value = glm::vec4(0.5f, 0.5f, 0.5f, 0.5f);
  for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
    FilterRig filter(in, plain_constants(), GetParam(), 4, kernel);
    const render::FloatImage got = filter.run();
    for (std::size_t i = 0; i < pixels; ++i) EXPECT_NEAR(got.rgba[4 * i], 0.5f, 1e-5f) << i;
  }
}

TEST_P(Atrous, PreservesEdgesBetweenSurfaces) {
  const std::array upper{glm::vec4(0, 0, 1.5f, 5), glm::vec4(0, 0, 1.5f, 5)};
  const std::array lower{glm::vec4(0, 1.5f, 0, 5),
                         glm::vec4(0, 0, 1.5f, 50)};  // rotated; far behind
  for (std::size_t edge = 0; edge < upper.size(); ++edge) {
    FilterInput in(1);
    for (std::size_t i = 0; i < pixels; ++i) {
      const bool below = i / width > 11;
      in.guide[i] = below ? lower[edge] : upper[edge];
      in.slope[i] = glm::vec2(0.0f);
      in.signal[i] = below ? glm::vec4(1, 1, 1, 9) : glm::vec4(0, 0, 0, 9);
      if (!GetParam()) in.signal[i].z = in.signal[i].w;
    }
    for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
      FilterRig filter(in, plain_constants(), GetParam(), 4, kernel);
      const render::FloatImage got = filter.run();
      for (std::size_t i = 0; i < pixels; ++i) {
        // Depth alone leaks slightly at the widest steps; without it half would leak.
        EXPECT_NEAR(got.rgba[4 * i], i / width > 11 ? 1.0f : 0.0f, edge == 0 ? 1e-4f : 0.01f)
            << i << ", edge " << edge;
      }
    }
  }
}

TEST_P(Atrous, ReducesNoiseAndVarianceOnUniformSurface) {
  FilterInput in(3);
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.3f, 5.0f);
    in.slope[i] = glm::vec2(0.0f);
    const float value = in.signal[i].x < 0.5f ? 0.0f : 1.0f;
    in.signal[i] = glm::vec4(value, value, GetParam() ? value : 0.25f, 0.25f);
  }
  for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
    FilterRig filter(in, plain_constants(), GetParam(), 4, kernel);
    const render::FloatImage got = filter.run();
    double mean = 0.0, squares = 0.0, left = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      mean += got.rgba[4 * i] / double(pixels);
      squares += double(got.rgba[4 * i]) * got.rgba[4 * i] / double(pixels);
      left += got.rgba[4 * i + 3] / double(pixels);
    }
    EXPECT_NEAR(mean, 0.5, 0.06);
    EXPECT_LT(squares - mean * mean, 0.25 / 20.0) << "of a variance of 1/4";
    EXPECT_LT(left, 0.25 / 20.0) << "filtered variance";
  }
}

TEST_P(Atrous, IgnoresBackground) {
  const float bright = 32768.0f;  // which 16 bits hold
  FilterInput in(5);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (in.guide[i].w == 0.0f) in.signal[i] = glm::vec4(bright);
  }
  FilterRig filter(in, plain_constants(), GetParam(), 3, protocol::BlurKernel::separable);
  const render::FloatImage got = filter.run();
  for (std::size_t i = 0; i < pixels; ++i) {
    if (in.guide[i].w == 0.0f) {
      EXPECT_EQ(got.rgba[4 * i], bright);
    } else {
      EXPECT_LE(got.rgba[4 * i], 1.0f);
    }
  }
}

/// With `flag`, surfaces of the first roughness are not filtered, of the second in one iteration,
/// of the third in all.
void expect_levels(std::uint32_t flag, const std::array<float, 3>& roughness) {
  FilterInput in(9);
  const auto third = [](std::size_t i) { return std::min<std::size_t>(i % width / 12, 2); };
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.0f + roughness[third(i)], 5.0f);
    in.slope[i] = glm::vec2(0.0f);
  }
  shared::AtrousConstants constants = plain_constants();
  constants.flags |= flag;
  FilterRig once(in, constants, true, 1), often(in, constants, true, 4);
  const render::FloatImage one = once.run(), four = often.run();
  for (std::size_t i = 0; i < pixels; ++i) {
    if (third(i) == 0) {
      EXPECT_EQ(four.rgba[4 * i], in.signal[i].x) << "a perfect mirror must not be blurred";
    } else if (third(i) == 1) {
      EXPECT_EQ(four.rgba[4 * i], one.rgba[4 * i]) << "one iteration";
      EXPECT_NE(four.rgba[4 * i], in.signal[i].x);
    } else {
      EXPECT_NE(four.rgba[4 * i], one.rgba[4 * i]);
    }
  }
}

TEST(AtrousLevels, FollowRoughnessForNoiseFreeHits) {
  expect_levels(shared::atrous_levels_by_roughness, {0.0015f, 0.049f, 0.051f});
}

TEST(AtrousLevels, StepGrowsWithinABandOfRoughness) {
  const float threshold = 0.5f;
  FilterInput in(9);
  const auto third = [](std::size_t i) { return std::min<std::size_t>(i % width / 12, 2); };
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.0f + threshold + 0.051f * (third(i) - 1.0f), 5.0f);
    in.slope[i] = glm::vec2(0.0f);
  }
  const auto filtered = [&](float start) {
    shared::AtrousConstants constants = plain_constants();
    constants.start_threshold = start;
    constants.level = 1;  // steps of 2, 3 in the middle of the band, and 4
    return FilterRig(in, constants, true).run();
  };
  const render::FloatImage band = filtered(threshold), small = filtered(2.0f),
                           large = filtered(-1.0f);
  std::array<bool, 2> differs{};
  for (std::size_t i = 0; i < pixels; ++i) {
    const float value = band.rgba[4 * i];
    if (third(i) == 0) {
      EXPECT_EQ(value, small.rgba[4 * i]);
    } else if (third(i) == 2) {
      EXPECT_EQ(value, large.rgba[4 * i]);
    } else {
      differs[0] |= value != small.rgba[4 * i];
      differs[1] |= value != large.rgba[4 * i];
    }
  }
  EXPECT_TRUE(differs[0] && differs[1]) << "half way between";
}

// Lobes of less than a pixel, of one to two pixels, and wider than the filter's footprint.
TEST(AtrousLevels, AreLimitedBySpecularLobeWidth) {
  expect_levels(shared::atrous_lobe_limit, {0.01f, 0.17f, 0.9f});
}

TEST(SeparableAtrous, UpdatesVarianceInSecondPassOnly) {
  protocol::Settings settings;
  settings.specular_blur.variance_update = protocol::VarianceUpdate::vertical_only;
  const auto flags = [&](bool first) {
    return render::atrous_constants(settings.specular_blur, {}, {0, 2, 0, first}).flags;
  };
  EXPECT_TRUE(flags(true) & shared::atrous_keep_variance);
  EXPECT_FALSE(flags(false) & shared::atrous_keep_variance);
  const FilterInput in(11);
  shared::AtrousConstants keep = plain_constants();
  keep.flags |= shared::atrous_keep_variance;
  FilterRig filter(in, keep, true);
  const render::FloatImage got = filter.run();
  for (std::size_t i = 0; i < pixels; ++i) EXPECT_EQ(got.rgba[4 * i + 3], in.signal[i].w);
}

}  // namespace
}  // namespace heliograph::test
