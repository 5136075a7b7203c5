#pragma once

#include "render/passes/compose/compose.hpp"

namespace heliograph::render {

struct FrameInputs;

/// How many blended surfaces behind each other a pixel shows; the nearest ones.
inline constexpr std::uint32_t most_blended = 6;

/// Lays the scene's blended surfaces over the composed picture, in place: glTF's alphaMode BLEND
/// and what lets light through. Rays through the pixels find them from front to back between the
/// camera and the G-buffer's surfaces, so that no order of drawing matters. They are lit as others
/// are, by one ray of each kind in every pixel, without a denoiser.
/// @return the motion of what is seen: of the surface that hides more than half of what is behind
/// it
gpu::ImageRef blend_surfaces(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const Composed& composed);

}  // namespace heliograph::render
