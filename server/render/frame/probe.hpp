#pragma once

#include "render/frame/compiled_frame.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

/// Renderer::inspect, of a compiled frame.
std::vector<BufferValue> inspect_buffers(const CompiledFrame& compiled, const ViewContext& context,
                                         glm::vec2 point);

/// The weight of the mean, where the last frame had one for all pixels, in place of what was read
/// of its image, which has no defined content then. Nothing of other buffers.
void fill_in_weight(const CompiledFrame& compiled, std::string_view buffer, FloatImage& values);

/// The linear radiance of the frame that is shown: the frame's own and the accumulated mean, by
/// their weights.
FloatImage shown_radiance(const CompiledFrame& compiled);

/// Renderer::pick, of a compiled frame.
protocol::Result<std::optional<SurfacePoint>> surface_at(const CompiledFrame& compiled,
                                                         const shared::FrameConstants& frame,
                                                         glm::vec2 point);

}  // namespace heliograph::render
