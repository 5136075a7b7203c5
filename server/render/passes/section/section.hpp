#pragma once

#include <optional>

#include "render/passes/frame_inputs.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// Whether planes cut this scene open; a change makes another plan.
bool has_section(const FrameInputs& in);

/// By pixel, which plane's cap it shows and of which instance; absent without planes.
using SectionCaps = std::optional<gpu::BufferRef>;
SectionCaps declare_caps(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name);
/// Finds them from the first hits of the camera's rays.
void find_caps(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays,
               gpu::BufferRef hits, const SectionCaps& caps);
/// Draws them over the surfaces behind.
void draw_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
               const GBuffer& gbuffer);
/// Gives a path traced sample their colour.
void color_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
                gpu::ImageRef radiance);

}  // namespace heliograph::render
