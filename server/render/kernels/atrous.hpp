#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// One iteration of the a-trous filter: shaders/lib/denoise/atrous.glsl. All images have the size
/// that AtrousConstants::pixels_per_texel tells.
template <class Stage>
struct AtrousBindings {
  gpu::Read<Stage> guide;        // rgba32f
  gpu::Read<Stage> depth_slope;  // rg32f
  gpu::Read<Stage> signal;       // rgba32f
  gpu::Write<Stage> filtered;    // rgba32f, another image than `signal`
};
using AtrousJob = FrameJob<AtrousBindings, shared::AtrousConstants>;

/// Both halves of a separable iteration at once: two passes of the shaders, without the image
/// between them.
struct AtrousHalves {
  shared::AtrousConstants first, second;  // one across and one down
};
using AtrousHalvesJob = FrameJob<AtrousBindings, AtrousHalves>;

/// On all processors, in the widest vectors that they have. The results agree with the shaders' up
/// to rounding.
void visibility_atrous(const AtrousJob& job);
void specular_atrous(const AtrousJob& job);
void visibility_atrous_halves(const AtrousHalvesJob& job);
void specular_atrous_halves(const AtrousHalvesJob& job);

}  // namespace heliograph::render::kernels
