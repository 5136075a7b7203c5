#pragma once

#include "gpu/device/vulkan.hpp"

// Formats and usages of images and buffers that several passes share.

namespace heliograph::render::formats {

inline constexpr VkFormat four_floats = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat four_halves = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat two_words = VK_FORMAT_R32G32_UINT;  // packed
inline constexpr VkFormat two_halves = VK_FORMAT_R16G16_SFLOAT;
inline constexpr VkFormat four_fractions = VK_FORMAT_R16G16B16A16_UNORM;
inline constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

}  // namespace heliograph::render::formats
