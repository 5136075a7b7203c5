#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// What every denoised signal is guided by.
struct Guide {
  gpu::ImageRef surface;  // world shading normal x (1 + roughness), view Z; 0: background
  gpu::ImageRef
      reprojection;  // xy: pixel of the frame before, z: bits of its valid taps, w: 1: none
};

/// Follows every surface to where it was one frame ago (SVGF, section 4.1). Tolerances are those of
/// the shadows' accumulation.
Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer);

}  // namespace heliograph::render
