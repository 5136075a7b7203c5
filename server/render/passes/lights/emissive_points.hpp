#pragma once

#include "render/kernels/common/tile.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// Whether emissive triangles are lights in this frame.
bool samples_emissive(const FrameInputs& in);

/// Draws the points of emissive triangles that receivers of a frame choose from.
/// @return shared::EmissivePoint each; in scenes without emissive triangles one that nothing may
/// read
gpu::BufferRef draw_emissive_points(gpu::FramePlan& plan, const FrameInputs& in);

/// Adds the light of emissive triangles, one shadow ray per pixel that has gathered (w >= 0), to
/// `radiance`: irradiance / pi. Of `rows`.
void add_emissive_light(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                        gpu::BufferRef points, gpu::ImageRef radiance, kernels::Rows rows);

}  // namespace heliograph::render
