#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

// Formats and usages of images and buffers that several passes share.

namespace heliograph::render::formats {

inline constexpr VkFormat four_floats = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat four_halves = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat two_words = VK_FORMAT_R32G32_UINT;  // packed
inline constexpr VkFormat two_halves = VK_FORMAT_R16G16_SFLOAT;
inline constexpr VkFormat four_fractions = VK_FORMAT_R16G16B16A16_UNORM;
inline constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

/// Whether images that need no more have 16 bits a channel: those of shaders, which take as long to
/// read texels as these have bytes. Kernels of the host read and write 32 bits.
inline bool in_halves(const gpu::FramePlan& plan) {
  return !plan.uses_host_kernels();
}

}  // namespace heliograph::render::formats
