#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// Surfaces and indirect light at half the size: shaders/indirect/indirect_halve.comp.
template <class Stage>
struct IndirectHalveBindings {
  gpu::Read<Stage> normals;        // rgba32f
  gpu::Read<Stage> motion;         // rgba32f
  gpu::Read<Stage> depth_slope;    // rg32f
  gpu::Read<Stage> instance;       // r32ui
  gpu::Read<Stage> radiance;       // rgba32f, as the others a texel for each pixel
  gpu::Write<Stage> half_normals;  // in the same formats, for each square of 2x2
  gpu::Write<Stage> half_motion;
  gpu::Write<Stage> half_slope;  // from texel to texel
  gpu::Write<Stage> half_instance;
  gpu::Write<Stage> half_surface;  // rgba8: as rough as can be
  gpu::Write<Stage> half_radiance;
};
using IndirectHalveJob = FrameJob<IndirectHalveBindings>;
void indirect_halve(const IndirectHalveJob& job);

/// What was denoised at half the size, at full size: shaders/indirect/indirect_upsample.comp.
template <class Stage>
struct IndirectUpsampleBindings {
  gpu::Read<Stage> guide;        // rgba32f
  gpu::Read<Stage> depth_slope;  // rg32f
  gpu::Read<Stage> half_guide;   // rgba32f
  gpu::Read<Stage> half_signal;  // rgba32f
  gpu::Write<Stage> denoised;    // rgba32f
};
using IndirectUpsampleJob = FrameJob<IndirectUpsampleBindings, shared::AtrousConstants>;
void indirect_upsample(const IndirectUpsampleJob& job);

}  // namespace heliograph::render::kernels
