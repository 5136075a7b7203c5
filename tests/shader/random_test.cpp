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

/// The pairs and numbers of one pixel, sample after sample.
std::vector<ShaderOutput> pixel_samples(const glm::uvec2& pixel, std::uint32_t count,
                                        std::uint32_t dimension, std::uint32_t first = 0) {
  std::vector<ShaderInput> inputs;
  for (std::uint32_t i = 0; i < count; ++i) {
    inputs.push_back(input({pixel.x, pixel.y, first + i}, dimension));
  }
  return numbers(inputs);
}

// A net: however a square of area 1 / 2^n is cut as a power of two by a power of two, each cell
// holds one of 2^n samples.
TEST(Random, SamplesOfAPixelAreAZeroTwoNetInEveryPrefix) {
  for (const glm::uvec2 pixel : {glm::uvec2(0, 0), {1, 0}, {639, 359}, {1917, 1078}}) {
    for (const std::uint32_t dimension : {1u, 2u, 40u}) {
      const auto all = pixel_samples(pixel, 512, dimension);
      for (const std::uint32_t first : {0u, 256u}) {
        for (std::uint32_t n = 0; n <= 8; ++n) {
          for (std::uint32_t across = 0; across <= n; ++across) {
            std::vector<int> cells(1u << n);
            for (std::uint32_t i = first; i < first + (1u << n); ++i) {
              const auto x = static_cast<std::uint32_t>(all[i].x.x * float(1u << across));
              const auto y = static_cast<std::uint32_t>(all[i].x.y * float(1u << (n - across)));
              ++cells[y << across | x];
            }
            for (const int count : cells) ASSERT_EQ(count, 1) << n << " " << across;
          }
          std::vector<int> line(1u << n);
          for (std::uint32_t i = first; i < first + (1u << n); ++i) {
            ++line[static_cast<std::size_t>(all[i].x.z * float(1u << n))];
          }
          for (const int count : line) ASSERT_EQ(count, 1) << n;
        }
      }
    }
  }
}

// The same over pixels: every square of the quadtree holds a net in every sample.
TEST(Random, PixelBlocksHoldANetInEverySample) {
  for (const std::uint32_t sample : {0u, 1u, 13u, 100000u}) {
    std::vector<ShaderInput> inputs;
    for (std::uint32_t i = 0; i < 64; ++i) inputs.push_back(input({8 + i % 8, 64 + i / 8, sample}));
    std::vector<int> cells(64);
    for (const ShaderOutput& output : numbers(inputs)) {
      ++cells[static_cast<int>(output.x.y * 8.0f) * 8 + static_cast<int>(output.x.x * 8.0f)];
    }
    for (const int count : cells) EXPECT_EQ(count, 1) << sample;
  }
}

TEST(Random, DimensionsSeedsAndDistantPixelsAreIndependent) {
  constexpr std::uint32_t size = 128;
  std::vector<ShaderInput> inputs, other_dimension, other_seed, other_tile;
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      inputs.push_back(input({x, y, 0}, 1));
      other_dimension.push_back(input({x, y, 0}, 2));
      other_seed.push_back(input({x, y, 0}, 1, 1));
      other_tile.push_back(input({x + size, y, 0}, 1));
    }
  }
  const auto base = numbers(inputs);
  std::vector<int> counts(16 * 16);
  for (const ShaderOutput& output : base) {
    ++counts[static_cast<int>(output.x.y * 16.0f) * 16 + static_cast<int>(output.x.x * 16.0f)];
  }
  EXPECT_LT(chi_square_deviation(counts), 4.0);

  const auto correlation = [&](const std::vector<ShaderOutput>& other) {
    double sum = 0.0;
    for (std::size_t i = 0; i < base.size(); ++i) {
      sum += (base[i].x.x - 0.5) * (other[i].x.x - 0.5);
    }
    return sum / static_cast<double>(base.size()) * 12.0;  // the variance of one is 1 / 12
  };
  // Four standard deviations of independent numbers' correlation.
  constexpr double limit = 4.0 / size;
  EXPECT_LT(std::abs(correlation(numbers(other_dimension))), limit);
  EXPECT_LT(std::abs(correlation(numbers(other_seed))), limit);
  EXPECT_LT(std::abs(correlation(numbers(other_tile))), limit);
}

// Dimensions with the same order of samples would lie on a few lines of their common square.
TEST(Random, PairsOfDimensionsOfAPixelAreStratified) {
  const auto one = pixel_samples({5, 9}, 1024, 1), other = pixel_samples({5, 9}, 1024, 2);
  std::vector<int> counts(8 * 8);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ++counts[static_cast<int>(one[i].x.x * 8.0f) * 8 + static_cast<int>(other[i].x.x * 8.0f)];
  }
  EXPECT_LT(chi_square_deviation(counts), 4.0);
}

constexpr int side = 128;

/// Root mean square of what is left of an image's error after a Gaussian blur, sigma 1 pixel.
double blurred_error(const std::vector<double>& error) {
  constexpr int reach = 3;
  double kernel[2 * reach + 1], total = 0.0, sum = 0.0;
  for (int i = -reach; i <= reach; ++i) total += kernel[i + reach] = std::exp(-0.5 * i * i);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      double value = 0.0;
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const int at = (y + j + side) % side * side + (x + i + side) % side;
          value += kernel[i + reach] * kernel[j + reach] * error[static_cast<std::size_t>(at)];
        }
      }
      sum += value * value;
    }
  }
  return std::sqrt(sum / (side * side)) / (total * total);
}

struct Errors {
  double sequence, white;
};

/// How far off the estimates of half a disk's area are after a blur, from our numbers and from
/// independent ones, with `samples` in every pixel from `first` on.
Errors disk_errors(std::uint32_t samples, std::uint32_t first) {
  const auto inside = [](double x, double y) { return x * x + y * y < 0.5 ? 1.0 : 0.0; };
  const double truth = 0.5 * 0.25 * 3.14159265358979;
  std::vector<double> ours(side * side, -truth), white(side * side, -truth);
  RandomInputs random(3);
  for (std::uint32_t s = first; s < first + samples; ++s) {
    std::vector<ShaderInput> inputs;
    for (std::uint32_t i = 0; i < side * side; ++i) {
      inputs.push_back(input({i % side, i / side, s}, 2));
    }
    const auto got = numbers(inputs);
    for (std::size_t i = 0; i < got.size(); ++i) {
      ours[i] += inside(got[i].x.x, got[i].x.y) / samples;
      white[i] += inside(random.uniform(0, 1), random.uniform(0, 1)) / samples;
    }
  }
  return {blurred_error(ours), blurred_error(white)};
}

TEST(Random, OneSampleErrorIsBlueNoise) {
  for (const std::uint32_t sample : {0u, 7u, 1234u}) {
    const Errors errors = disk_errors(1, sample);
    EXPECT_LT(errors.sequence, 0.75 * errors.white) << sample;
  }
}

TEST(Random, ErrorConvergesWithOneOverTheSampleCount) {
  const double few = disk_errors(4, 0).sequence, many = disk_errors(64, 0).sequence;
  EXPECT_LT(many, few / 7.0) << "independent numbers would gain a factor of 4";
  EXPECT_LT(many, disk_errors(64, 0).white / 3.0);
}

}  // namespace
}  // namespace heliograph::test
