#pragma once

#include <random>
#include <set>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// Synthetic frame images with planes, edges, holes and various materials, for tests that compare
/// host kernels with their shaders.
class RandomFrame {
 public:
  explicit RandomFrame(FrameRig& rig, unsigned seed = 7) : rig_(rig), random_(seed) {}

  /// A G-buffer and that of the previous frame, in which most surfaces are slightly displaced.
  render::GBuffer gbuffer();
  /// RGBA32F, uniform between `low` and `high`.
  gpu::ImageRef four(const std::string& name, const glm::vec4& low, const glm::vec4& high);
  gpu::ImageRef two(const std::string& name, float low, float high);
  /// R32F of 0 or 1, like noisy visibility.
  gpu::ImageRef bits(const std::string& name);

  float unit() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }

 private:
  struct Surfaces;
  Surfaces surfaces(float shift);

  FrameRig& rig_;
  std::mt19937 random_;
};

/// The rig's inputs with host kernels on or off.
const render::FrameInputs& with_host_kernels(FrameRig& rig, bool host);

/// The inputs with another tracer, which outlives them.
render::FrameInputs with_tracer(const render::FrameInputs& in, const tracing::RayTracer& tracer);

struct ErrorStatistics {
  double mean;       // of |expected - actual| / (1 + |expected|)
  double max;        // of the same
  double outliers;   // fraction of values that differ by more than 0.01
  double magnitude;  // mean of |expected|
};
ErrorStatistics compare(const render::FloatImage& expected, const render::FloatImage& actual);

/// Expects two G-buffers of one plan to be the same but for samples on edges, which may belong to
/// either triangle, and for texels that round to the next 1/255.
void expect_same_gbuffer(const FrameRig& rig, const render::GBuffer& expected,
                         const render::GBuffer& actual, const std::string& which);

/// Prints by what factor the device passes are slower than the host kernels of `passes`, and
/// expects at least `least`. Minimum of several frames; the device is timed by the wall clock,
/// because GPU timestamps do not advance in some drivers.
void expect_faster(FrameRig& rig, const std::set<std::string>& passes, double least);

bool has_host_kernels();

}  // namespace heliograph::test
