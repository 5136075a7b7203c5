#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "scene/scene.hpp"
#include "shaders/shared/texture_heap.h"

namespace heliograph::render {

/// All textures of a scene where any compute shader can read any of them by a number: not every
/// device indexes sampled images freely.
struct TextureHeap {
  gpu::Buffer texels;    // RGBA8, one uint each; a uniform texel buffer
  gpu::Buffer textures;  // shared::HeapTexture by texture index
};

/// Where everything lies in a heap. Images keep their levels from the first whose larger side is at
/// most 1024 texels; fewer where the device cannot address so many texels in one buffer.
struct HeapPlan {
  struct Slot {             // of an image, texels
    std::uint64_t skipped;  // levels of it that are left out
    std::uint64_t kept;     // 0 where an image before has the same texels
    std::uint64_t first;    // in the heap
  };
  std::vector<Slot> slots;
  std::vector<shared::HeapTexture> textures;
  std::uint64_t texels = 0;
};

/// Fills a heap image by image, so that no more than one of them need be decoded at a time.
class TextureHeapWriter {
 public:
  TextureHeapWriter(const gpu::Device& device, const scene::Scene& scene);

  /// `pixels` are all levels of the image of that number.
  void add(std::size_t image, std::span<const std::uint8_t> pixels);
  /// Once every image was added.
  TextureHeap finish();

 private:
  const gpu::Device& device_;
  const HeapPlan plan_;
  gpu::Buffer texels_;                   // where the host reaches it
  std::vector<std::uint32_t> gathered_;  // where not
};

struct PackedTextures {
  std::vector<std::uint32_t> texels;
  std::vector<shared::HeapTexture> textures;
};
/// The heap without a device, for tests. @throws gpu::GpuError when the images do not fit
PackedTextures pack_textures(const scene::Scene& scene, std::uint64_t most_texels);

}  // namespace heliograph::render
