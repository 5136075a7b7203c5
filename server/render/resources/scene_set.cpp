#include "render/resources/scene_set.hpp"

#include <algorithm>

namespace heliograph::render {

std::vector<gpu::DescriptorLayout::Binding> scene_bindings() {
  return {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},       {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},       {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {4, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},       {5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {6, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}, {7, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {8, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},       {9, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
}

void write_scene_set(const gpu::Device& device, VkDescriptorSet set,
                     const tracing::SceneTables& tables, const TextureHeap& heap,
                     const gpu::Buffer& layers, const EmissiveBuffers& emissive) {
  constexpr auto storage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  // Of larger ones see SceneResources::for_kernels_only.
  const auto bound_size = [&](const gpu::Buffer& table) {
    return std::min<VkDeviceSize>(table.size(), device.limits().maxStorageBufferRange);
  };
  gpu::DescriptorWriter(device, set)
      .buffer(0, storage, tables.vertices.handle(), 0, bound_size(tables.vertices))
      .buffer(1, storage, tables.indices.handle(), 0, bound_size(tables.indices))
      .buffer(2, storage, tables.meshes.handle())
      .buffer(3, storage, tables.instances.handle())
      .buffer(4, storage, tables.materials.handle())
      .buffer(5, storage, heap.textures.handle())
      .texel_buffer(6, heap.texels.texel_view(VK_FORMAT_R32_UINT))
      .buffer(7, storage, layers.handle())
      .buffer(8, storage, emissive.table.handle())
      .buffer(9, storage, emissive.first.handle())
      .apply();
}

}  // namespace heliograph::render
