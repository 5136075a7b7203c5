#include <gtest/gtest.h>

#include <cmath>

#include "tests/shader/chi_square.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

glm::vec2 halves(std::uint32_t number) {
  return {static_cast<float>(number >> 16), static_cast<float>(number & 0xffffu)};
}

std::uint32_t whole(const glm::vec2& halves) {
  return static_cast<std::uint32_t>(halves.x) << 16 | static_cast<std::uint32_t>(halves.y);
}

ShaderInput input(const glm::uvec3& v, std::uint32_t dimension = 0, std::uint32_t seed = 0) {
  return {.a = glm::vec4(halves(v.x), halves(v.y)),
          .b = glm::vec4(halves(v.z), static_cast<float>(dimension), static_cast<float>(seed))};
}

/// Jarzynski and Olano 2020, listing of pcg3d.
glm::uvec3 pcg3d_twin(glm::uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

std::vector<ShaderOutput> numbers(const std::vector<ShaderInput>& inputs) {
  return ShaderFunctions(shaders::random).call(1, inputs);
}

TEST(Random, HashIsTheSameOnDeviceAndHost) {
  RandomInputs random(1);
  std::vector<glm::uvec3> given{{0, 0, 0}, {~0u, ~0u, ~0u}};
  while (given.size() < 5000) given.emplace_back(random.bits(), random.bits(), random.bits());
  std::vector<ShaderInput> inputs;
  for (const auto& v : given) inputs.push_back(input(v));
  const auto got = ShaderFunctions(shaders::random).call(0, inputs);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const glm::vec4 x = got[i].x, y = got[i].y;
    const glm::uvec3 hashed(whole({x.x, x.y}), whole({x.z, x.w}), whole({y.x, y.y}));
    ASSERT_EQ(hashed, pcg3d_twin(given[i])) << i;
  }
}

TEST(Random, NumbersLieBelowOneForEverySample) {
  RandomInputs random(2);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 20000; ++i) {
    inputs.push_back(input({random.bits() % 8192, random.bits() % 8192, random.bits()},
                           random.bits() % 64, random.bits() % 65536));
  }
  for (const ShaderOutput& output : numbers(inputs)) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_GE(output.x[i], 0.0f);
      ASSERT_LT(output.x[i], 1.0f);
    }
  }
}

TEST(Random, OnePixelsSamplesFillTheSquareEvenly) {
  constexpr int samples = 256, cells = 8;
  for (const glm::uvec2 pixel : {glm::uvec2(0, 0), {1, 0}, {639, 359}, {1917, 1078}}) {
    for (const std::uint32_t dimension : {1u, 2u, 3u}) {
      std::vector<ShaderInput> inputs;
      for (std::uint32_t i = 0; i < samples; ++i) {
        inputs.push_back(input({pixel.x, pixel.y, i}, dimension));
      }
      std::vector<int> counts(cells * cells), line(samples / 4);
      for (const ShaderOutput& output : numbers(inputs)) {
        ++counts[static_cast<int>(output.x.y * cells) * cells +
                 static_cast<int>(output.x.x * cells)];
        ++line[static_cast<int>(output.x.z * static_cast<float>(line.size()))];
      }
      // Four are due in each cell; independent numbers would leave some empty and crowd others.
      for (const int count : counts) {
        EXPECT_GE(count, 1);
        EXPECT_LE(count, 8);
      }
      for (const int count : line) {
        EXPECT_GE(count, 2);
        EXPECT_LE(count, 6);
      }
    }
  }
}

TEST(Random, NeighboursDimensionsAndSeedsAreIndependent) {
  constexpr std::uint32_t size = 128;
  std::vector<ShaderInput> inputs, other_dimension, other_seed;
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      inputs.push_back(input({x, y, 0}, 1));
      other_dimension.push_back(input({x, y, 0}, 2));
      other_seed.push_back(input({x, y, 0}, 1, 1));
    }
  }
  const auto base = numbers(inputs);
  std::vector<int> counts(16 * 16);
  for (const ShaderOutput& output : base) {
    ++counts[static_cast<int>(output.x.y * 16.0f) * 16 + static_cast<int>(output.x.x * 16.0f)];
  }
  EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.0);

  const auto correlation = [&](const std::vector<ShaderOutput>& other, std::size_t shift) {
    double sum = 0.0;
    for (std::size_t i = 0; i + shift < base.size(); ++i) {
      sum += (base[i].x.x - 0.5) * (other[i + shift].x.x - 0.5);
    }
    return sum / static_cast<double>(base.size()) * 12.0;  // the variance of one is 1 / 12
  };
  // Four standard deviations of independent numbers' correlation.
  constexpr double limit = 4.0 / size;
  EXPECT_LT(std::abs(correlation(base, 1)), limit) << "right neighbour";
  EXPECT_LT(std::abs(correlation(base, size)), limit) << "neighbour below";
  EXPECT_LT(std::abs(correlation(numbers(other_dimension), 0)), limit);
  EXPECT_LT(std::abs(correlation(numbers(other_seed), 0)), limit);
}

}  // namespace
}  // namespace heliograph::test
