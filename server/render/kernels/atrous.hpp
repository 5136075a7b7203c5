#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/denoise.h"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// What a signal's four floats are: shaders/lib/denoise/visibility_signal.glsl and
/// specular_signal.glsl.
enum class Signal { visibility, specular };

/// The mapped images of one iteration, in the shader's order.
struct AtrousImages {
  gpu::HostView guide;        // rgba32f
  gpu::HostView depth_slope;  // rg32f
  gpu::HostView signal;       // rgba32f
  gpu::HostView filtered;     // rgba32f, another image than `signal`
};

/// One iteration of the a-trous filter on all processors: shaders/lib/denoise/atrous.glsl in the
/// widest vectors that the processor has. The results agree up to rounding.
void atrous(Signal signal, const shared::AtrousConstants& constants,
            const shared::FrameConstants& frame, const AtrousImages& images);

}  // namespace heliograph::render::kernels
