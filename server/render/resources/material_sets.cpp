#include <array>
#include <cstring>
#include <memory>
#include <mutex>

#include "render/resources/scene_resources.hpp"

// What the rasteriser reads of materials.

namespace heliograph::render {
namespace {

VkDeviceSize aligned(VkDeviceSize size, VkDeviceSize alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

/// Uniform blocks, `stride` bytes apart.
template <typename Element>
gpu::Buffer make_blocks(const gpu::Device& device, std::span<const Element> elements,
                        VkDeviceSize stride, gpu::Memory memory) {
  std::vector<std::byte> blocks(stride * elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    std::memcpy(blocks.data() + i * stride, &elements[i], sizeof(Element));
  }
  constexpr auto usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
  if (memory != gpu::Memory::upload) {
    return gpu::upload_buffer(device, "material blocks", blocks, usage);
  }
  gpu::Buffer buffer(device, "material blocks", blocks.size(), usage, memory);
  std::memcpy(buffer.mapped(), blocks.data(), blocks.size());
  return buffer;
}

/// In the order of the shader's bindings.
std::array<const shared::TextureSlot*, material_textures> slots_of(const shared::Material& m) {
  return {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
          &m.occlusion_texture, &m.emissive_texture};
}

std::array<const shared::TextureSlot*, shared::layer_textures> slots_of(
    const shared::MaterialLayer& l) {
  return {&l.specular_texture,
          &l.specular_color_texture,
          &l.coat_texture,
          &l.coat_roughness_texture,
          &l.coat_normal_texture,
          &l.sheen_color_texture,
          &l.sheen_roughness_texture,
          &l.transmission_texture,
          &l.thickness_texture,
          &l.iridescence_texture,
          &l.film_texture,
          &l.anisotropy_texture,
          &l.diffuse_transmission_texture,
          &l.diffuse_tint_texture};
}

/// Of all slots of every material, with those of its layer where it has one.
std::vector<std::uint32_t> textures_of(const MaterialTables& tables, bool layered) {
  std::vector<std::uint32_t> textures;
  for (const shared::Material& material : tables.materials) {
    for (const auto* const slot : slots_of(material)) textures.push_back(slot->texture);
    if (!layered) continue;
    for (const auto* const slot : slots_of(tables.layers[material.layer])) {
      textures.push_back(slot->texture);
    }
  }
  return textures;
}

std::vector<shared::MaterialLayer> layers_by_material(const MaterialTables& tables) {
  std::vector<shared::MaterialLayer> layers;
  for (const auto& material : tables.materials) layers.push_back(tables.layers[material.layer]);
  return layers;
}

}  // namespace

bool MaterialSets::write(const MaterialTables& tables) const {
  const bool layered = layer_stride > 0;
  if (textures_of(tables, layered) != textures) return false;
  for (std::size_t i = 0; i < tables.materials.size(); ++i) {
    const shared::Material& material = tables.materials[i];
    std::memcpy(blocks.mapped() + i * stride, &material, sizeof material);
    if (!layered) continue;
    const shared::MaterialLayer& layer = tables.layers[material.layer];
    std::memcpy(layer_blocks.mapped() + i * layer_stride, &layer, sizeof layer);
  }
  return true;
}

void SceneResources::write_slots(gpu::DescriptorWriter& writer, std::uint32_t first_binding,
                                 std::span<const shared::TextureSlot* const> slots,
                                 const shared::TextureSlot* normal) const {
  for (std::uint32_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t texture = slots[i]->texture;
    if (texture == shared::no_texture) {
      const gpu::Image& constant = slots[i] == normal ? flat_normal_ : white_;
      writer.sampled_image(first_binding + i, constant.view(), samplers_.back().handle());
    } else {
      writer.sampled_image(first_binding + i, images_[scene->textures[texture].image].view(),
                           samplers_[texture_sampler_[texture]].handle());
    }
  }
}

MaterialSets SceneResources::make_material_sets(const MaterialTables& tables, bool layered,
                                                gpu::Memory memory) const {
  const std::lock_guard lock(sampled_mutex_);
  make_missing_images();
  const auto& [materials, layers] = tables;
  MaterialSets made;
  made.textures = textures_of(tables, layered);
  const auto count = static_cast<std::uint32_t>(materials.size());
  constexpr std::uint32_t most_textures = material_textures + shared::layer_textures;
  made.pool = std::make_unique<gpu::DescriptorPool>(device_, count, count * most_textures);
  const VkDeviceSize alignment = device_.limits().minUniformBufferOffsetAlignment;
  made.stride = aligned(sizeof(shared::Material), alignment);
  made.blocks = make_blocks(device_, materials, made.stride, memory);
  if (layered) {
    made.layer_stride = aligned(sizeof(shared::MaterialLayer), alignment);
    const std::vector<shared::MaterialLayer> own = layers_by_material(tables);
    made.layer_blocks = make_blocks(device_, std::span(own), made.layer_stride, memory);
  }
  for (const shared::Material& material : materials) {
    const VkDescriptorSet set = made.pool->allocate(programs_.material_layout(layered).handle());
    gpu::DescriptorWriter writer(device_, set);
    write_slots(writer, 0, slots_of(material), &material.normal_texture);
    constexpr auto uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    writer.buffer(material_textures, uniform, made.blocks.handle(), made.sets.size() * made.stride,
                  sizeof(shared::Material));
    if (layered) {
      const shared::MaterialLayer& layer = layers[material.layer];
      write_slots(writer, material_textures + 1, slots_of(layer), &layer.coat_normal_texture);
      writer.buffer(most_textures + 1, uniform, made.layer_blocks.handle(),
                    made.sets.size() * made.layer_stride, sizeof(shared::MaterialLayer));
    }
    writer.apply();
    made.sets.push_back(set);
  }
  return made;
}

}  // namespace heliograph::render
