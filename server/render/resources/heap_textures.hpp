#pragma once

#include "gpu/device/device.hpp"
#include "scene/image/mipmaps.hpp"

namespace heliograph::render {

inline constexpr std::uint32_t longest_heap_side = 1024;

/// The levels of images that a texture heap on the device takes.
inline scene::KeptTextures heap_textures(const gpu::Device& device) {
  return {longest_heap_side, device.limits().maxTexelBufferElements};
}

/// What uploads to the device need of images: all levels, unless they go into a heap.
inline scene::KeptTextures kept_textures(const gpu::Device& device) {
  return device.is_cpu() ? heap_textures(device) : scene::KeptTextures();
}

}  // namespace heliograph::render
