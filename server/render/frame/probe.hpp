#pragma once

#include "render/frame/compiled_frame.hpp"
#include "render/views/view_table.hpp"

namespace heliograph::render {

/// Renderer::inspect, of a drawing.
std::vector<BufferValue> inspect_buffers(const Drawing& drawing, const ViewContext& context,
                                         float share_of_mean, glm::vec2 point);

/// The radiance that the picture is made from: the frame's own and the mean of its samples, which
/// has this share in it.
FloatImage shown_radiance(const Drawing& drawing, float share_of_mean);

/// Renderer::pick, of a drawing.
protocol::Result<std::optional<SurfacePoint>> surface_at(const Drawing& drawing,
                                                         const shared::FrameConstants& frame,
                                                         glm::vec2 point);

}  // namespace heliograph::render
