#pragma once

#include "render/passes/frame_inputs.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// Whether surfaces are shown otherwise than as they are (`view.shading`). The G-buffer is found by
/// rays then, which know triangles.
bool changes_shading(const FrameInputs& in);

/// Changes what the G-buffer says of the surfaces that these camera rays have met. Wireframe: edges
/// have a colour of their own. Clay: all are grey. Other modes: unlit, in the mode's colour.
void draw_shading(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays,
                  gpu::BufferRef hits, const GBuffer& gbuffer);

/// What a mode leaves of the settings: modes without light trace none, and the path traced
/// reference knows clay alone.
void choose_shading(protocol::Settings& settings);

/// Whether a mode gives all surfaces one plain material (MovingScene::set_plain).
bool is_plain(const protocol::Settings& settings);

}  // namespace heliograph::render
