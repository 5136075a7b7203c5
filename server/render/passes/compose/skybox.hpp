#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

inline constexpr struct SkyboxBuffers {
  BufferDescription radiance{"skybox", ViewColors::radiance,
                             "Radiance of the background behind the scene."};
} skybox_buffers{};

/// Linear radiance of the background where no surface was drawn; elsewhere black.
gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer);

}  // namespace heliograph::render
