#pragma once

#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// The same G-buffer as trace_gbuffer's, by a rasteriser on the host: the nearest triangle of every
/// pixel is drawn, and where its surface lets rays pass the one behind. No ray is traced. Its cost
/// follows the triangles, but each costs a tenth of a ray.
/// @param blended what the pixels' blended surfaces are laid over on the way, if anything
GBuffer draw_gbuffer(gpu::FramePlan& plan, const FrameInputs& in,
                     const BlendedImages* blended = nullptr);

/// Whether the host draws the G-buffer of this plan: where host kernels run, unless the settings
/// ask for rays or there are so many triangles that rays find it sooner.
bool draws_gbuffer_on_host(const gpu::FramePlan& plan, const FrameInputs& in);

}  // namespace heliograph::render
