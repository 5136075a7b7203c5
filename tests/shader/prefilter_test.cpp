#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t reflection = 2;  // of frame_functions.comp

/// A gradient with a bright patch of 30 degrees, where filters have most to do.
glm::vec3 sky_with_lamp(const glm::vec3& d) {
  const glm::vec3 lamp = glm::normalize(glm::vec3(0.4f, 0.5f, -0.7f));
  const float bright = glm::smoothstep(std::cos(0.30f), std::cos(0.22f), glm::dot(d, lamp));
  return glm::vec3(0.5f + 0.3f * d.y, 0.4f, 0.4f - 0.2f * d.x) + 8.0f * bright;
}

/// The first sum of the split sum (Karis 2013) in double precision: N = V, light weighted by the
/// density of reflected GGX half vectors and n.l.
glm::dvec3 filtered(const glm::dvec3& n, double roughness) {
  const double a2 = std::pow(roughness, 4.0);
  constexpr int rows = 200;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < 2 * rows * rows; ++i) {
    const double theta = (i / (2 * rows) + 0.5) / rows * pi,
                 phi = (i % (2 * rows) + 0.5) / rows * pi;
    const glm::dvec3 l(std::sin(theta) * std::cos(phi), std::cos(theta),
                       std::sin(theta) * std::sin(phi));
    const double cosine = glm::dot(n, l);
    if (cosine <= 0.0) continue;
    const double h2 = 0.5 * (1.0 + cosine);  // squared cosine of the half vector
    const double d = h2 * (a2 - 1.0) + 1.0;
    const double weight = a2 / (d * d) * cosine * std::sin(theta);
    sum += weight * glm::dvec3(sky_with_lamp(l));
    weights += weight;
  }
  return sum / weights;
}

TEST(Prefilter, LevelsMatchTheCpuReferencesGgxLobes) {
  RigOptions options;
  options.environment = make_environment(512, sky_with_lamp);
  const FrameRig rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), options);
  const float levels = static_cast<float>(rig.constants().prefiltered_levels);
  ASSERT_GE(levels, 4.0f);
  RandomInputs random(9);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 120; ++i) {
    const float roughness = (1.0f + static_cast<float>(i % 4)) / (levels - 1.0f);
    inputs.push_back({.a = glm::vec4(random.unit_vector(), std::min(roughness, 1.0f))});
  }
  const auto got = ShaderFunctions(shaders::frame_functions, &rig).call(reflection, inputs);
  double total = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::dvec3 expected = filtered(glm::dvec3(inputs[i].a), inputs[i].a.w);
    const double error = glm::distance(glm::dvec3(glm::vec3(got[i].x)), expected);
    EXPECT_LT(error, 0.06 * glm::length(expected) + 0.02) << "roughness " << inputs[i].a.w;
    total += glm::length(expected);
    apart += error;
  }
  EXPECT_LT(apart / total, 0.015);
}

}  // namespace
}  // namespace heliograph::test
