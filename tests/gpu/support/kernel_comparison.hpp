#pragma once

#include <random>
#include <set>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// Made-up images of what a frame holds, with planes, edges, holes and materials of all sorts, for
/// tests that compare host kernels with the shaders they are twins of.
class RandomFrame {
 public:
  explicit RandomFrame(FrameRig& rig, unsigned seed = 7) : rig_(rig), random_(seed) {}

  /// A G-buffer, and that of a frame before in which most surfaces lie elsewhere by a little.
  render::GBuffer gbuffer();
  /// Four numbers from `low` to `high`.
  gpu::ImageRef four(const std::string& name, const glm::vec4& low, const glm::vec4& high);
  gpu::ImageRef two(const std::string& name, float low, float high);
  /// 0 or 1, as visibility is.
  gpu::ImageRef bits(const std::string& name);

  float unit() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }

 private:
  struct Surfaces;
  Surfaces surfaces(float shift);

  FrameRig& rig_;
  std::mt19937 random_;
};

/// The same frame by shaders alone, or with host kernels.
render::FrameInputs with_kernels(const FrameRig& rig, bool host);

struct Compared {
  double mean;   // of the absolute difference, over 1 + the value
  double worst;  // of pixels
  double apart;  // share of values that differ by more than a hundredth
  double size;   // mean of the absolute value
};
Compared compare(const render::FloatImage& expected, const render::FloatImage& found);

/// Prints how many times longer everything on the device takes than the host's passes of these
/// names, its twins, and requires `least`. The best of several frames, the device's by the clock:
/// its timers stand still in some drivers.
void expect_faster(FrameRig& rig, const std::set<std::string>& passes, double least);

bool has_host_kernels();

}  // namespace heliograph::test
