#pragma once

#include "render/gbuffer.hpp"

namespace heliograph::render {

/// The same G-buffer as rasterize_gbuffer, found by rays through the pixels: its cost follows the
/// pixels, not the triangles. Depth slopes are those of the surface's plane, texture detail that of
/// a ray cone (Akenine-Möller et al. 2021). Behind three surfaces that let a ray pass, the fourth
/// is taken as it is. `depth` stays empty.
GBuffer trace_gbuffer(gpu::FramePlan& plan, const FrameInputs& in);

/// Whether rays find the G-buffer on this device with these settings.
bool traces_gbuffer(const FrameInputs& in);

}  // namespace heliograph::render
