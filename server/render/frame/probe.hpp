#pragma once

#include "render/frame/compiled_frame.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

/// Renderer::inspect, of a compiled frame.
std::vector<BufferValue> inspect_buffers(const CompiledFrame& compiled, const ViewContext& context,
                                         float mean_weight, glm::vec2 point);

/// The linear radiance of the frame that is shown: the frame's own and the accumulated mean, which
/// has this weight.
FloatImage shown_radiance(const CompiledFrame& compiled, float mean_weight);

/// Renderer::pick, of a compiled frame.
protocol::Result<std::optional<SurfacePoint>> surface_at(const CompiledFrame& compiled,
                                                         const shared::FrameConstants& frame,
                                                         glm::vec2 point);

}  // namespace heliograph::render
