#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/memory/image.hpp"

namespace heliograph::gpu {

/// The layout of a descriptor set that several programs share.
class DescriptorLayout {
 public:
  struct Binding {
    std::uint32_t binding;
    VkDescriptorType type;
  };
  DescriptorLayout(const Device& device, std::string name, std::vector<Binding> bindings);
  ~DescriptorLayout();
  DescriptorLayout(const DescriptorLayout&) = delete;
  DescriptorLayout& operator=(const DescriptorLayout&) = delete;

  VkDescriptorSetLayout handle() const { return handle_; }
  const std::string& name() const { return name_; }
  const std::vector<Binding>& bindings() const { return bindings_; }
  const Binding* find(std::uint32_t binding) const;

 private:
  const Device& device_;
  std::string name_;
  std::vector<Binding> bindings_;
  VkDescriptorSetLayout handle_ = VK_NULL_HANDLE;
};

/// Room for `sets` descriptor sets of the given layout; sets live as long as the pool.
class DescriptorPool {
 public:
  DescriptorPool(const Device& device, std::uint32_t sets, std::uint32_t descriptors_of_each_type);
  ~DescriptorPool();
  DescriptorPool(const DescriptorPool&) = delete;
  DescriptorPool& operator=(const DescriptorPool&) = delete;

  VkDescriptorSet allocate(VkDescriptorSetLayout layout) const;

 private:
  const Device& device_;
  VkDescriptorPool handle_ = VK_NULL_HANDLE;
};

/// Collects writes to one descriptor set and applies them together.
class DescriptorWriter {
 public:
  DescriptorWriter(const Device& device, VkDescriptorSet set) : device_(device), set_(set) {}
  DescriptorWriter& buffer(std::uint32_t binding, VkDescriptorType type, VkBuffer buffer,
                           VkDeviceSize offset = 0, VkDeviceSize size = VK_WHOLE_SIZE);
  DescriptorWriter& texel_buffer(std::uint32_t binding, VkBufferView view);
  DescriptorWriter& storage_image(std::uint32_t binding, VkImageView view);
  DescriptorWriter& sampled_image(std::uint32_t binding, VkImageView view, VkSampler sampler);
  void apply();

 private:
  struct Write {
    std::uint32_t binding;
    VkDescriptorType type;
    VkDescriptorBufferInfo buffer{};
    VkDescriptorImageInfo image{};
    VkBufferView view = VK_NULL_HANDLE;
  };
  const Device& device_;
  VkDescriptorSet set_;
  std::vector<Write> writes_;
};

}  // namespace heliograph::gpu
