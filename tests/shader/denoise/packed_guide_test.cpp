#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum PackedFunction : std::uint32_t { guides, slopes, halves };

std::vector<ShaderOutput> packed_call(PackedFunction function,
                                      const std::vector<ShaderInput>& inputs) {
  return ShaderFunctions(shaders::packed_guide).call(function, inputs);
}

TEST(PackedGuide, KeepsDepthAndRoughnessAndNearlyTheNormal) {
  RandomInputs random(3);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 20000; ++i) {
    const float roughness = static_cast<float>(i % 256) / 255.0f;
    inputs.push_back({.a = glm::vec4(random.unit_vector(), roughness),
                      .b = glm::vec4(std::exp(random.uniform(-12.0f, 12.0f)))});
  }
  const auto got = packed_call(guides, inputs);
  double most = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec3 normal(got[i].x);
    ASSERT_EQ(got[i].y.x, inputs[i].b.x) << "view Z";
    ASSERT_NEAR(got[i].x.w, inputs[i].a.w, 1e-6f) << "roughness";
    ASSERT_EQ(got[i].y.y, 0.0f) << "no background";
    ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f);
    most = std::max(most, double(glm::distance(normal, glm::vec3(inputs[i].a))));
  }
  EXPECT_LT(most, glm::radians(0.06));
  EXPECT_EQ(got[0].y.z, 1.0f) << "the background is one";
}

TEST(PackedGuide, KeepsNormalsAlongAxes) {
  std::vector<ShaderInput> inputs;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec4 normal(0.0f);
      normal[axis] = sign;
      inputs.push_back({.a = normal, .b = glm::vec4(1.0f)});
    }
  }
  const auto got = packed_call(guides, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    EXPECT_LT(glm::distance(glm::vec3(got[i].x), glm::vec3(inputs[i].a)), 1e-6f) << i;
  }
}

TEST(PackedGuide, KeepsSlopesInScenesOfAnySize) {
  RandomInputs random(4);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 3000; ++i) {
    const float size = std::array{1e-6f, 1.0f, 1e6f}[i % 3];
    const float part = std::exp(random.uniform(std::log(1e-3f), 0.0f));
    inputs.push_back({.a = {size * part, -0.5f * size * part, size, 0.0f}});
  }
  const auto got = packed_call(slopes, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec2 texel(got[i].y);
    ASSERT_NEAR(got[i].x.x / inputs[i].a.x, 1.0f, 6e-4f) << i;
    ASSERT_NEAR(got[i].x.y / inputs[i].a.y, 1.0f, 6e-4f) << i;
    ASSERT_EQ(glm::unpackHalf2x16(glm::packHalf2x16(texel)), texel) << "half floats hold it";
  }
}

TEST(NearestHalves, AreHalvesWithinHalfAStepAndNoDarkerOnAverage) {
  RandomInputs random(5);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 20000; ++i) {
    const float size = std::exp(random.uniform(std::log(1e-4f), std::log(6e4f)));
    inputs.push_back({.a = {size, -size, 0.0f, 1.0f}});
  }
  const auto got = packed_call(halves, inputs);
  double drift = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const float value = got[i].x.x;
    ASSERT_EQ(glm::unpackHalf1x16(glm::packHalf1x16(value)), value);
    ASSERT_NEAR(value / inputs[i].a.x, 1.0f, 1.0f / 2048.0f + 1e-6f);
    ASSERT_EQ(got[i].x.y, -value);
    ASSERT_EQ(got[i].x.z, 0.0f);
    ASSERT_EQ(got[i].x.w, 1.0f);
    drift += (value / double(inputs[i].a.x) - 1.0) / double(inputs.size());
  }
  EXPECT_NEAR(drift, 0.0, 1e-5);
}

TEST(NearestHalves, AreFinite) {
  for (const float size : {65504.0f, 65519.0f, 65520.0f, 1e9f, 3e38f}) {
    const auto got = packed_call(halves, {{.a = {size, -size, 0.0f, 0.0f}}});
    EXPECT_EQ(got[0].x.x, 65504.0f) << size;
    EXPECT_EQ(got[0].x.y, -65504.0f) << size;
  }
}

}  // namespace
}  // namespace heliograph::test
