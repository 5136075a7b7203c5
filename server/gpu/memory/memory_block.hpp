#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu/device/device.hpp"

namespace heliograph::gpu {

/// Memory of the device that several resources share; mapped on devices that are processors.
class MemoryBlock {
 public:
  /// `requirements`: what all of them allow and ask for together.
  MemoryBlock(const Device& device, const VkMemoryRequirements& requirements,
              const std::string& name);
  ~MemoryBlock();
  MemoryBlock(const MemoryBlock&) = delete;
  MemoryBlock& operator=(const MemoryBlock&) = delete;

  VkDeviceMemory handle() const { return memory_; }
  /// Of the byte at `offset`; null where it is not mapped.
  std::byte* mapped(VkDeviceSize offset) const { return mapped_ ? mapped_ + offset : nullptr; }
  VkDeviceSize size() const { return size_; }

 private:
  const Device& device_;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::byte* mapped_ = nullptr;
  VkDeviceSize size_;
};

/// Where in a block a resource lies; without a block it has memory of its own.
struct MemoryPlace {
  std::shared_ptr<const MemoryBlock> block;
  VkDeviceSize offset = 0;
};

}  // namespace heliograph::gpu
