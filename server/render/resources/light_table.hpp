#pragma once

#include <span>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/scene.h"

namespace heliograph::render {

inline constexpr VkFormat light_texel_format = VK_FORMAT_R32G32B32A32_UINT;

/// A table of any number of lights as shaders/lib/lighting/lights.glsl reads it: the first
/// shared::uniform_lights from a uniform block, the others as texels of four words.
gpu::Buffer make_light_table(const gpu::Device& device, std::size_t count);

/// Fills a table that has room for them. Never while a frame runs that reads it.
void write_lights(const gpu::Buffer& table, std::span<const shared::Light> lights);

/// The lights of a frame as light_number() of shaders/lib/lighting/lights.glsl gives them, the
/// environment's sun last, from a table that the host can reach.
std::vector<shared::Light> frame_lights(const gpu::Buffer& table,
                                        const shared::FrameConstants& frame);

}  // namespace heliograph::render
