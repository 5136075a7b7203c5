#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/resources/environment/environment_table.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

constexpr double pi = std::numbers::pi;
enum Function : std::uint32_t { sample, density };

/// Bright toward one side, with a window and a dark ground.
glm::vec3 radiance_of(const glm::vec3& d) {
  if (d.y < -0.2f) return glm::vec3(0.0f);
  const bool window = d.x > 0.5f && d.y > 0.1f && d.y < 0.6f;
  return glm::vec3(0.2f + 0.5f * d.y, 0.3f, 0.5f) + glm::vec3(window ? 20.0f : 0.0f);
}

class EnvironmentSampling : public testing::Test {
 protected:
  EnvironmentSampling() {
    RigOptions options;
    options.environment = make_environment(64, radiance_of);
    options.settings.environment.rotation = 35.0f;
    SceneBuilder builder;
    rig_ = std::make_unique<FrameRig>(builder.build(), look({0, 0, 3}, {0, 0, 0}), options);
  }
  std::vector<ShaderOutput> call(Function function, const std::vector<ShaderInput>& inputs) {
    return ShaderFunctions(shaders::environment_sampling, rig_.get()).call(function, inputs);
  }
  std::vector<ShaderOutput> draw(int count) {
    RandomInputs random(3);
    std::vector<ShaderInput> inputs;
    for (int i = 0; i < count; ++i) {
      inputs.push_back({.a = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1),
                              random.uniform(0, 1)}});
    }
    return call(sample, inputs);
  }
  std::unique_ptr<FrameRig> rig_;
};

TEST_F(EnvironmentSampling, DensityIntegratesToOneAndFollowsTheRotatedEnvironment) {
  std::vector<ShaderInput> inputs;
  std::vector<double> solid_angles;
  constexpr int rows = 256;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < 2 * rows; ++x) {
      const double theta = (y + 0.5) / rows * pi, phi = (x + 0.5) / rows * pi;
      inputs.push_back({.a = {std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi), 0}});
      solid_angles.push_back((std::cos(y * pi / rows) - std::cos((y + 1) * pi / rows)) * pi / rows);
    }
  }
  const auto got = call(density, inputs);
  double sum = 0.0, brightest = 0.0, dimmest = 1e30;
  for (std::size_t i = 0; i < got.size(); ++i) {
    sum += got[i].x.x * solid_angles[i];
    if (got[i].y.x > 10.0f) dimmest = std::min<double>(dimmest, got[i].x.x);
    if (got[i].y.z == 0.0f) brightest = std::max<double>(brightest, got[i].x.x);
  }
  EXPECT_NEAR(sum, 1.0, 0.01);
  EXPECT_GT(dimmest, 5.0 * brightest) << "where it is bright and where it is dark";
}

// Pearson's test over the cells of a coarser grid about the drawn directions.
TEST_F(EnvironmentSampling, DirectionsFollowTheDensity) {
  const auto cells = render::make_environment_table(make_environment(64, radiance_of));
  ASSERT_EQ(cells.size(), 64u * 32u);
  constexpr int count = 200000;
  const auto got = draw(count);
  std::vector<double> counts(cells.size(), 0.0);
  const float angle = glm::radians(35.0f);
  for (const ShaderOutput& s : got) {
    const glm::vec3 d(std::cos(angle) * s.x.x - std::sin(angle) * s.x.z, s.x.y,
                      std::sin(angle) * s.x.x + std::cos(angle) * s.x.z);
    const double u = 0.5 + std::atan2(d.z, d.x) / (2.0 * pi), v = std::acos(d.y) / pi;
    const int x = std::min(static_cast<int>(u * 64), 63),
              y = std::min(static_cast<int>(v * 32), 31);
    ++counts[y * 64 + x];
  }
  double statistic = 0.0, freedom = -1.0, rest = 0.0, rest_expected = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double top = static_cast<double>(i / 64) * pi / 32;
    const double expected =
        count * cells[i].density * (std::cos(top) - std::cos(top + pi / 32)) * pi / 32;
    if (expected < 10.0) {
      rest += counts[i];
      rest_expected += expected;
      continue;
    }
    statistic += (counts[i] - expected) * (counts[i] - expected) / expected;
    freedom += 1.0;
  }
  statistic += (rest - rest_expected) * (rest - rest_expected) / rest_expected;
  EXPECT_LT(statistic, freedom + 4.5 * std::sqrt(2.0 * freedom));
  EXPECT_GT(freedom, 200.0);
}

TEST_F(EnvironmentSampling, EstimateConvergesToTheEnvironmentsIrradiance) {
  const auto got = draw(100000);
  double sum = 0.0;
  for (const ShaderOutput& s : got) {
    ASSERT_GT(s.x.w, 0.0f);
    ASSERT_NEAR(glm::length(glm::vec3(s.x)), 1.0f, 1e-3f);
    sum += s.y.y / s.x.w / got.size();
  }
  // The environment's own texels: its window has edges.
  const scene::Environment picture = make_environment(64, radiance_of);
  double expected = 0.0;
  for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
    const double top = static_cast<double>(i / 64) * pi / 32;
    expected += picture.radiance[i].y * (std::cos(top) - std::cos(top + pi / 32)) * pi / 32;
  }
  EXPECT_NEAR(sum / expected, 1.0, 0.02);
}

}  // namespace
}  // namespace heliograph::test
