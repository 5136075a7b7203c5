#pragma once

#include <array>

#include "gpu/device/vulkan.hpp"

namespace heliograph::render {

/// Formats of the G-buffer's colour attachments in the order of struct GBuffer, without the layers,
/// which come last where a scene has them.
inline constexpr std::array gbuffer_formats{VK_FORMAT_R32G32B32A32_SFLOAT,
                                            VK_FORMAT_R8G8B8A8_UNORM,
                                            VK_FORMAT_R8G8B8A8_UNORM,
                                            VK_FORMAT_R32G32B32A32_SFLOAT,
                                            VK_FORMAT_R16G16B16A16_SFLOAT,
                                            VK_FORMAT_R32G32_SFLOAT,
                                            VK_FORMAT_R32_UINT};
inline constexpr VkFormat gbuffer_layers_format = VK_FORMAT_R32G32B32A32_UINT;

}  // namespace heliograph::render
