#pragma once

#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// The same G-buffer as trace_gbuffer's rounds find, by fewer passes that walk the tracer's
/// hierarchy themselves: no camera ray is stored, and what goes on behind the first surface is
/// traced to its end in one pass. No pass of others sees rays or hits. Where camera rays are drawn,
/// backs that draw_camera_rays leaves out do not count among the surfaces that a ray may pass.
GBuffer walk_gbuffer(gpu::FramePlan& plan, const FrameInputs& in,
                     const tracing::WalkedHierarchy& hierarchy);

/// What walk_gbuffer needs, where it replaces the rounds: on GPUs whose tracer has it, unless caps
/// of section planes or a shading mode ask for rays and hits.
std::optional<tracing::WalkedHierarchy> walked_gbuffer(const gpu::FramePlan& plan,
                                                       const FrameInputs& in);

}  // namespace heliograph::render
