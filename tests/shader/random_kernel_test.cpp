// The random numbers of host kernels are those of the shaders, to the bit: a frame must not
// depend on whether a shader or a kernel generated its rays.

#include <gtest/gtest.h>

#include "render/kernels/simd/random.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::test {
namespace {

namespace kernels = render::kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

struct Place {
  std::uint32_t x, y, sample, dimension, seed;
};

glm::vec2 halves(std::uint32_t number) {
  return {static_cast<float>(number >> 16), static_cast<float>(number & 0xffffu)};
}

/// What the vector kernels generate: a pair, and a single number.
glm::vec3 host_numbers(const Place& place) {
  const hn::ScalableTag<std::uint32_t> du;
  const hn::RebindToFloat<decltype(du)> df;
  const auto x = hn::Set(du, place.x);
  auto first = hn::Zero(df), second = first;
  kernels::RandomPairs(du, place.sample, place.dimension, place.seed).at(x, place.y, first, second);
  const auto single = kernels::RandomNumbers(du, place.sample, place.dimension, place.seed)
                          .at(x, hn::Set(du, place.y));
  return {hn::GetLane(first), hn::GetLane(second), hn::GetLane(single)};
}

TEST(RandomKernel, MatchesTheShaderBitForBit) {
  RandomInputs random(7);
  std::vector<Place> places{{0, 0, 0, 0, 0}, {65535, 65535, ~0u, 300, 4095}};
  while (places.size() < 5000) {
    places.push_back({random.bits() & 0xffffu, random.bits() & 0xffffu, random.bits(),
                      random.bits() % 512u, random.bits() & 0xffffu});
  }
  std::vector<ShaderInput> inputs;
  for (const Place& p : places) {
    inputs.push_back({.a = glm::vec4(halves(p.x), halves(p.y)),
                      .b = glm::vec4(halves(p.sample), static_cast<float>(p.dimension),
                                     static_cast<float>(p.seed))});
  }
  const auto shader = ShaderFunctions(shaders::random).call(1, inputs);
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_EQ(host_numbers(places[i]), glm::vec3(shader[i].x)) << i;
  }
}

}  // namespace
}  // namespace heliograph::test
HWY_AFTER_NAMESPACE();
