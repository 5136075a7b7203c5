#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// The part of its light that arrives at each texel of the plane that catches shadows
/// (shaders/shared/ground.h), from which shadows over the background follow in every view. Where
/// nothing catches shadows it is one number that is not read. Traces rays until their means hardly
/// change; the first passes of a frame, because the host writes what they read.
gpu::BufferRef trace_ground(gpu::FramePlan& plan, const FrameInputs& in);

/// Darkens the background by the shadows on the ground in front of it.
void shade_ground(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                  gpu::BufferRef ground, gpu::ImageRef background);

}  // namespace heliograph::render
