#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/views/debug_view.hpp"
#include "tests/shader/chi_square.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { sample, density };
constexpr double pi = std::numbers::pi;

glm::vec3 view_at(float degrees) {
  const float angle = glm::radians(degrees);
  return {std::sin(angle), 0.0f, std::cos(angle)};
}

/// Samples on a regular grid of the two numbers, in the middle of its cells.
std::vector<ShaderOutput> grid_samples(const glm::vec3& view, float alpha, int size) {
  std::vector<ShaderInput> inputs;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec2 u((x + 0.5f) / size, (y + 0.5f) / size);
      inputs.push_back({.a = glm::vec4(view, alpha), .b = glm::vec4(u, 0, 0)});
    }
  }
  return ShaderFunctions(shaders::sampling).call(sample, inputs);
}

/// `alpha_y`: along y; 0: the same as along x.
std::vector<ShaderOutput> random_samples(const glm::vec3& view, float alpha, int count,
                                         float alpha_y = 0.0f) {
  RandomInputs random(5);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < count; ++i) {
    const glm::vec2 u(random.uniform(0, 1), random.uniform(0, 1));
    inputs.push_back({.a = glm::vec4(view, alpha), .b = glm::vec4(u, 0, alpha_y)});
  }
  return ShaderFunctions(shaders::sampling).call(sample, inputs);
}

/// Pearson's statistic of counts against what each should be, as a standard normal number.
double deviation_from(const std::vector<int>& counts, const std::vector<double>& expected) {
  double statistic = 0.0, pooled_count = 0.0, pooled_expected = 0.0;
  int classes = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 8.0) {
      pooled_count += counts[i];
      pooled_expected += expected[i];
      continue;
    }
    statistic += std::pow(counts[i] - expected[i], 2.0) / expected[i];
    ++classes;
  }
  if (pooled_expected > 8.0) {
    statistic += std::pow(pooled_count - pooled_expected, 2.0) / pooled_expected;
    ++classes;
  }
  const double freedom = classes - 1, variance = 2.0 / (9.0 * freedom);
  return (std::cbrt(statistic / freedom) - (1.0 - variance)) / std::sqrt(variance);
}

constexpr int rings = 24, sectors = 32;

int cell_of(const glm::vec3& light) {
  const double turn = std::atan2(light.y, light.x) / (2.0 * pi) + 0.5;
  const int sector = std::min(static_cast<int>(turn * sectors), sectors - 1);
  const double height = std::clamp((light.z + 1.0) * 0.5, 0.0, 1.0);
  return std::min(static_cast<int>(height * rings), rings - 1) * sectors + sector;
}

/// Fraction of all samples that should fall into each cell of the sphere of directions: the
/// integral of the density that the shader states, by the midpoint rule.
std::vector<double> cell_shares(const glm::vec3& view, float alpha, float alpha_y = 0.0f) {
  constexpr int fine = 24;
  std::vector<ShaderInput> inputs;
  for (int r = 0; r < rings * fine; ++r) {
    for (int s = 0; s < sectors * fine; ++s) {
      const double z = 2.0 * (r + 0.5) / (rings * fine) - 1.0, ring = std::sqrt(1.0 - z * z);
      const double angle = 2.0 * pi * (s + 0.5) / (sectors * fine) - pi;
      inputs.push_back(
          {.a = glm::vec4(view, alpha),
           .b = glm::vec4(ring * std::cos(angle), ring * std::sin(angle), z, alpha_y)});
    }
  }
  const auto got = ShaderFunctions(shaders::sampling).call(density, inputs);
  std::vector<double> shares(rings * sectors);
  const double area = 4.0 * pi / static_cast<double>(inputs.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    shares[static_cast<std::size_t>(cell_of(glm::vec3(inputs[i].b)))] += got[i].x.x * area;
  }
  return shares;
}

/// Whether drawn directions follow the density that the shader states, which sums to 1.
void expect_samples_of_density(const glm::vec3& view, float alpha, float alpha_y) {
  constexpr int count = 200'000;
  std::vector<double> expected = cell_shares(view, alpha, alpha_y);
  double total = 0.0;
  for (double& share : expected) {
    total += share;
    share *= count;
  }
  EXPECT_NEAR(total, 1.0, 5e-3) << "density is not normalised: " << alpha << " " << alpha_y;
  std::vector<int> counts(expected.size());
  for (const ShaderOutput& output : random_samples(view, alpha, count, alpha_y)) {
    ++counts[static_cast<std::size_t>(cell_of(glm::vec3(output.y)))];
  }
  EXPECT_LT(deviation_from(counts, expected), 4.5) << alpha << " " << alpha_y << " " << view.z;
}

// The azimuth too: a peer's code scales both numbers when it means to trim the tail of the lobe,
// and a fifth of the circle stays empty.
TEST(VisibleNormals, DirectionsFollowTheDensityAllAround) {
  for (const float alpha : {0.25f, 0.5f, 1.0f}) {
    for (const float degrees : {0.0f, 40.0f, 75.0f}) {
      expect_samples_of_density(view_at(degrees), alpha, alpha);
    }
  }
}

// KHR_materials_anisotropy: the eye looks along the grain, across it, and between.
TEST(VisibleNormals, DirectionsOfLobesWithGrainFollowTheDensity) {
  for (const float degrees : {0.0f, 40.0f, 75.0f}) {
    expect_samples_of_density(view_at(degrees), 0.7f, 0.25f);
    expect_samples_of_density(view_at(degrees), 0.25f, 0.7f);
    const glm::vec3 along = view_at(degrees);
    expect_samples_of_density({along.x * 0.6f, along.x * 0.8f, along.z}, 0.7f, 0.25f);
  }
}

TEST(VisibleNormals, SamplesCoverAllAzimuths) {
  std::vector<int> sectors_hit(36);
  for (const ShaderOutput& output : random_samples(view_at(0.0f), 0.5f, 50'000)) {
    ++sectors_hit[std::min(
        35, static_cast<int>((std::atan2(output.y.y, output.y.x) / (2.0 * pi) + 0.5) * 36.0))];
  }
  EXPECT_LT(chi_square_deviation(sectors_hit), 4.0);
}

TEST(VisibleNormals, ZeroRoughnessIsAPerfectMirror) {
  for (const float degrees : {0.0f, 30.0f, 89.0f, 89.99f}) {
    for (const ShaderOutput& output : grid_samples(view_at(degrees), 0.0f, 16)) {
      // Exact but for the last bits, which devices may round as they like.
      EXPECT_LE(glm::distance(glm::vec3(output.x), glm::vec3(0, 0, 1)), 1e-6f) << degrees;
      const glm::vec3 view = view_at(degrees);
      EXPECT_LE(glm::distance(glm::vec3(output.y), glm::vec3(-view.x, -view.y, view.z)), 1e-6f);
      EXPECT_FLOAT_EQ(output.x.w, 1.0f);
    }
  }
}

TEST(VisibleNormals, DirectionsBelowTheHorizonHaveZeroWeight) {
  int below = 0;
  for (const float degrees : {60.0f, 85.0f, 89.9f}) {
    for (const ShaderOutput& output : grid_samples(view_at(degrees), 1.0f, 64)) {
      EXPECT_NEAR(glm::length(glm::vec3(output.y)), 1.0f, 1e-4f);
      EXPECT_GE(output.x.w, 0.0f);
      EXPECT_LE(output.x.w, 1.0f + 1e-5f);
      if (output.y.z > 0.0f) continue;
      ++below;
      EXPECT_EQ(output.x.w, 0.0f);
    }
  }
  EXPECT_GT(below, 100);
}

TEST(VisibleNormals, WeightIsG2OverG1) {
  RandomInputs random(7);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 2000; ++i) {
    glm::vec3 view = random.unit_vector(), light = random.unit_vector();
    view.z = std::abs(view.z) + 0.01f;
    light.z = std::abs(light.z) + 0.01f;
    inputs.push_back({.a = glm::vec4(glm::normalize(view), random.uniform(0.01f, 1.0f)),
                      .b = glm::vec4(glm::normalize(light), 0)});
  }
  const auto got = ShaderFunctions(shaders::sampling).call(density, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto lambda = [alpha = double(inputs[i].a.w)](double cosine) {
      const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
      return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
    };
    const double v = lambda(inputs[i].a.z), l = lambda(inputs[i].b.z);
    EXPECT_NEAR(got[i].x.y, (1.0 + v) / (1.0 + v + l), 2e-4) << i;
  }
}

/// Reads the table that composition demodulates by.
glm::vec2 split_sum(float n_dot_v, float roughness) {
  const gpu::Image& image = engine().parts().split_sum_table;
  const render::FloatImage table = render::read_image(image, image.desc().extent);
  const auto index = [&](float value, std::uint32_t size) {
    return std::min(static_cast<std::uint32_t>(value * static_cast<float>(size)), size - 1);
  };
  return glm::vec2(texel(table, index(n_dot_v, table.width), index(roughness, table.height)));
}

TEST(VisibleNormals, MeanWeightEqualsTheSplitSum) {
  constexpr float table_size = 128.0f;
  for (const float row : {12.5f, 40.5f, 80.5f, 127.5f}) {
    for (const float column : {20.5f, 64.5f, 120.5f}) {
      const float n_dot_v = column / table_size, roughness = row / table_size;
      const glm::vec3 view(std::sqrt(1.0f - n_dot_v * n_dot_v), 0.0f, n_dot_v);
      const auto samples = grid_samples(view, roughness * roughness, 128);
      glm::dvec2 sum(0.0);
      for (const ShaderOutput& output : samples) {
        const double v_dot_h = glm::dot(view, glm::vec3(output.x));
        const double grazing = std::pow(1.0 - v_dot_h, 5.0);
        sum += double(output.x.w) * glm::dvec2(1.0 - grazing, grazing);
      }
      sum /= static_cast<double>(samples.size());
      const glm::vec2 expected = split_sum(n_dot_v, roughness);
      EXPECT_NEAR(sum.x, expected.x, 0.004) << n_dot_v << " " << roughness;
      EXPECT_NEAR(sum.y, expected.y, 0.002) << n_dot_v << " " << roughness;
    }
  }
}

}  // namespace
}  // namespace heliograph::test
