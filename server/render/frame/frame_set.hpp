#pragma once

#include "render/frame/engine_parts.hpp"

namespace heliograph::render {

/// Points set 0 (shaders/lib/frame.glsl) at a frame's constants, its lights and its environment.
void write_frame_set(const Engine::Parts& parts, VkDescriptorSet set, const gpu::Buffer& constants,
                     const gpu::Buffer& lights, const EnvironmentView& environment);

}  // namespace heliograph::render
