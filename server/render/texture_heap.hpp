#pragma once

#include "gpu/buffer.hpp"
#include "scene/scene.hpp"
#include "shaders/shared/texture_heap.h"

namespace heliograph::render {

/// All textures of a scene where any compute shader can read any of them by a number: not every
/// device indexes sampled images freely.
struct TextureHeap {
  gpu::Buffer texels;    // RGBA8, one uint each; a uniform texel buffer
  gpu::Buffer textures;  // shared::HeapTexture by texture index
};

/// Images keep their levels from the first whose larger side is at most 1024 texels; fewer where
/// the device cannot address so many texels in one buffer.
TextureHeap make_texture_heap(const gpu::Device& device, const scene::Scene& scene);

/// The same with another limit, for images packed into at most `most_texels`.
struct PackedTextures {
  std::vector<std::uint32_t> texels;
  std::vector<shared::HeapTexture> textures;
};
PackedTextures pack_textures(const scene::Scene& scene, std::uint64_t most_texels);

}  // namespace heliograph::render
