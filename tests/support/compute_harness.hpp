#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// Arguments and results of a function under test (tests/shader/harness.glsl).
struct ShaderInput {
  glm::vec4 a{0.0f}, b{0.0f}, c{0.0f}, d{0.0f};
};
struct ShaderOutput {
  glm::vec4 x{0.0f}, y{0.0f};
};

/// Calls functions of a test shader on the device for many inputs at once.
class ShaderFunctions {
 public:
  /// `rig` provides set 0 for functions that read frame constants or the environment.
  explicit ShaderFunctions(const gpu::ShaderBinary& shader, const FrameRig* rig = nullptr);

  std::vector<ShaderOutput> call(std::uint32_t function, std::span<const ShaderInput> inputs) const;

 private:
  const FrameRig* rig_;
  gpu::ComputeProgram program_;
};

}  // namespace heliograph::test
