#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace heliograph::test {

/// Numbers for tests: the same in every run.
class RandomInputs {
 public:
  explicit RandomInputs(std::uint32_t seed) : generator_(seed) {}
  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(generator_);
  }
  glm::vec3 unit_vector() {
    std::normal_distribution<float> normal;
    return glm::normalize(glm::vec3(normal(generator_), normal(generator_), normal(generator_)));
  }
  std::uint32_t bits() { return static_cast<std::uint32_t>(generator_()); }

 private:
  std::mt19937 generator_;
};

}  // namespace heliograph::test
