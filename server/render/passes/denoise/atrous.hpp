#pragma once

#include <functional>
#include <optional>
#include <string>

#include "protocol/settings/settings.hpp"
#include "render/kernels/atrous.hpp"
#include "render/passes/denoise/reproject.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render {

struct KernelShape;

/// A blur of one signal: how often, and what its passes read every frame.
struct Blur {
  std::string name;  // of the signal; begins the passes' names
  const gpu::ComputeProgram& program;
  int iterations;
  protocol::BlurKernel kernel;
  std::function<shared::AtrousConstants(const KernelShape&)> constants;
  kernels::Signal kind;
};

/// An image that the result of iteration `level` is written to, for the next frame.
struct Feedback {
  int level;
  gpu::ImageRef image;
};

/// The a-trous filter (Dammertz et al. 2010; paper sections 3.2 and 3.3): `iterations` passes, or
/// twice as many halves, whose distance between taps doubles from one to the next. The result is
/// the last iteration's.
gpu::ImageRef blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                   const Guide& guide, const Blur& blur, gpu::ImageRef signal,
                   std::optional<Feedback> feedback);

}  // namespace heliograph::render
