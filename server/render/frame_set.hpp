#pragma once

#include "render/engine_parts.hpp"

namespace heliograph::render {

/// Points set 0 (shaders/lib/frame.glsl) at a frame's constants, its lights, its environment and
/// the layers of its materials.
void write_frame_set(const Engine::Parts& parts, VkDescriptorSet set, const gpu::Buffer& constants,
                     const gpu::Buffer& lights, const EnvironmentView& environment,
                     const gpu::Buffer& layers);

}  // namespace heliograph::render
