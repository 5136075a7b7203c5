#include "gpu/memory/descriptors.hpp"

#include <array>
#include <utility>

namespace heliograph::gpu {

DescriptorLayout::DescriptorLayout(const Device& device, std::string name,
                                   std::vector<Binding> bindings)
    : device_(device), name_(std::move(name)), bindings_(std::move(bindings)) {
  std::vector<VkDescriptorSetLayoutBinding> infos;
  for (const Binding& binding : bindings_) {
    infos.push_back({binding.binding, binding.type, 1, VK_SHADER_STAGE_ALL, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = static_cast<std::uint32_t>(infos.size());
  info.pBindings = infos.data();
  check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &handle_),
        "create a descriptor set layout");
}

DescriptorLayout::~DescriptorLayout() {
  vkDestroyDescriptorSetLayout(device_.handle(), handle_, nullptr);
}

const DescriptorLayout::Binding* DescriptorLayout::find(std::uint32_t number) const {
  for (const Binding& binding : bindings_) {
    if (binding.binding == number) return &binding;
  }
  return nullptr;
}

DescriptorPool::DescriptorPool(const Device& device, std::uint32_t sets,
                               std::uint32_t descriptors_of_each_type)
    : device_(device) {
  std::array<VkDescriptorPoolSize, 5> sizes{};
  constexpr VkDescriptorType types[] = {
      VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
      VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER};
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = {types[i], descriptors_of_each_type};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = sets;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  check(vkCreateDescriptorPool(device.handle(), &info, nullptr, &handle_),
        "create a descriptor pool");
}

DescriptorPool::~DescriptorPool() {
  vkDestroyDescriptorPool(device_.handle(), handle_, nullptr);
}

VkDescriptorSet DescriptorPool::allocate(VkDescriptorSetLayout layout) const {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorPool = handle_;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  check(vkAllocateDescriptorSets(device_.handle(), &info, &set), "allocate a descriptor set");
  return set;
}

DescriptorWriter& DescriptorWriter::buffer(std::uint32_t binding, VkDescriptorType type,
                                           VkBuffer buffer, VkDeviceSize offset,
                                           VkDeviceSize size) {
  writes_.push_back({binding, type, {buffer, offset, size}, {}, VK_NULL_HANDLE});
  return *this;
}

DescriptorWriter& DescriptorWriter::texel_buffer(std::uint32_t binding, VkBufferView view) {
  writes_.push_back({binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, view});
  return *this;
}

DescriptorWriter& DescriptorWriter::storage_image(std::uint32_t binding, VkImageView view) {
  writes_.push_back({binding,
                     VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                     {},
                     {VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL},
                     VK_NULL_HANDLE});
  return *this;
}

DescriptorWriter& DescriptorWriter::sampled_image(std::uint32_t binding, VkImageView view,
                                                  VkSampler sampler) {
  writes_.push_back({binding,
                     VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                     {},
                     {sampler, view, VK_IMAGE_LAYOUT_GENERAL},
                     VK_NULL_HANDLE});
  return *this;
}

void DescriptorWriter::apply() {
  std::vector<VkWriteDescriptorSet> infos;
  for (const Write& write : writes_) {
    VkWriteDescriptorSet info{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    info.dstSet = set_;
    info.dstBinding = write.binding;
    info.descriptorCount = 1;
    info.descriptorType = write.type;
    info.pBufferInfo = &write.buffer;
    info.pImageInfo = &write.image;
    info.pTexelBufferView = &write.view;
    infos.push_back(info);
  }
  vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(infos.size()), infos.data(),
                         0, nullptr);
  writes_.clear();
}

}  // namespace heliograph::gpu
