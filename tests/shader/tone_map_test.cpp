#include <gtest/gtest.h>

#include <cmath>

#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { neutral = 4, aces, agx, srgb };

std::vector<glm::vec3> call(Function function, const std::vector<glm::vec3>& colors) {
  std::vector<ShaderInput> inputs;
  for (const glm::vec3& color : colors) inputs.push_back({.a = glm::vec4(color, 0.0f)});
  std::vector<glm::vec3> result;
  for (const auto& output : ShaderFunctions(shaders::brdf).call(function, inputs)) {
    result.emplace_back(output.x);
  }
  return result;
}

class ToneMap : public testing::TestWithParam<Function> {};

TEST_P(ToneMap, IsMonotonicAndKeepsGreyNeutral) {
  std::vector<glm::vec3> greys;
  for (int i = 0; i <= 2000; ++i) {
    greys.emplace_back(static_cast<float>(std::pow(10.0, -4.0 + 7.0 * i / 2000.0)));
  }
  const auto got = call(GetParam(), greys);
  for (std::size_t i = 0; i < got.size(); ++i) {
    // The published matrices' rows sum to one only to three digits.
    EXPECT_NEAR(got[i].x, got[i].y, 3e-3f);
    EXPECT_NEAR(got[i].z, got[i].y, 3e-3f);
    EXPECT_GE(got[i].y, -1e-6f);
    EXPECT_LE(got[i].y, 1.001f);
    if (i == 0) continue;
    EXPECT_GE(got[i].y, got[i - 1].y - 1e-6f) << greys[i].y;
  }
}

TEST_P(ToneMap, MapsBlackToBlackAndHugeValuesToWhite) {
  const auto got = call(GetParam(), {glm::vec3(0.0f), glm::vec3(1e4f)});
  EXPECT_LE(glm::length(got[0]), 2e-3f);
  EXPECT_GE(std::min({got[1].x, got[1].y, got[1].z}), 0.97f);
}

std::string curve_name(const testing::TestParamInfo<Function>& info) {
  constexpr const char* names[] = {"neutral", "aces", "agx"};
  return names[info.param - neutral];
}

INSTANTIATE_TEST_SUITE_P(Curves, ToneMap, testing::Values(neutral, aces, agx), curve_name);

// Khronos PBR Neutral 1.0: below the shoulder a colour only loses its Fresnel offset, 0.04 at
// most.
TEST(NeutralToneMap, OffsetsColorsBelowTheShoulderOnly) {
  RandomInputs random(1);
  std::vector<glm::vec3> colors;
  for (int i = 0; i < 3000; ++i) {
    colors.emplace_back(random.uniform(0, 0.8f), random.uniform(0, 0.8f), random.uniform(0, 0.8f));
  }
  const auto got = call(neutral, colors);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const float darkest = std::min({colors[i].x, colors[i].y, colors[i].z});
    const float offset = darkest < 0.08f ? darkest - 6.25f * darkest * darkest : 0.04f;
    const glm::vec3 shifted = colors[i] - offset;
    if (std::max({shifted.x, shifted.y, shifted.z}) >= 0.76f) continue;
    EXPECT_LE(glm::distance(got[i], shifted), 1e-6f);
  }
}

TEST(NeutralToneMap, KeepsBrightColorsInGamutAndDesaturatesThem) {
  RandomInputs random(2);
  std::vector<glm::vec3> colors;
  for (int i = 0; i < 3000; ++i) {
    const float gain = std::pow(10.0f, random.uniform(0, 4));
    colors.push_back(gain *
                     glm::vec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)));
  }
  for (const glm::vec3& color : call(neutral, colors)) {
    EXPECT_GE(std::min({color.x, color.y, color.z}), -1e-5f);
    EXPECT_LE(std::max({color.x, color.y, color.z}), 1.0f + 1e-5f);
  }
  const auto red = call(neutral, {glm::vec3(1e3f, 0.0f, 0.0f)});
  EXPECT_GT(red[0].y, 0.9f);
}

TEST(SrgbEncode, FollowsTheStandard) {
  std::vector<glm::vec3> colors{{-1.0f, 0.0f, 2.0f}};
  for (int i = 0; i <= 3000; ++i) colors.emplace_back(static_cast<float>(i) / 3000.0f);
  const auto got = call(srgb, colors);
  EXPECT_EQ(got[0].x, 0.0f);
  EXPECT_EQ(got[0].y, 0.0f);
  EXPECT_NEAR(got[0].z, 1.0f, 1e-6f);
  for (std::size_t i = 1; i < colors.size(); ++i) {
    const double linear = colors[i].y;
    const double expected =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
    EXPECT_NEAR(got[i].y, expected, 2e-6);
  }
}

}  // namespace
}  // namespace heliograph::test
