#pragma once

#include "render/passes/compose/compose.hpp"

namespace heliograph::render {

inline constexpr struct DefocusBuffers {
  BufferDescription hdr{"defocus.hdr", ViewColors::radiance,
                        "The frame's radiance behind the lens, denoised: linear."};
  BufferDescription noisy{"defocus.noisy", ViewColors::radiance,
                          "The frame's radiance behind the lens, from the noisy signals: linear."};
} defocus_buffers{};

/// What a lens makes of the frame, with `lens.depth_of_field`: every pixel gathers from those whose
/// circles of confusion reach it, at most a twelfth of the height away. What is in front of it
/// covers it by the share of its circle, what is behind shines through around its edges, and what
/// is sharp bleeds nowhere. Blended surfaces are as blurred as what is behind them.
/// @param composed returned as it is without depth of field
Composed defocus(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const Composed& composed);

}  // namespace heliograph::render
