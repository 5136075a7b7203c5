#include "gpu/memory/memory_block.hpp"

namespace heliograph::gpu {

MemoryBlock::MemoryBlock(const Device& device, const VkMemoryRequirements& requirements,
                         const std::string& name)
    : device_(device), size_(requirements.size) {
  constexpr VkMemoryPropertyFlags host =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  memory_ = device.allocate(requirements, device.is_cpu() ? host : 0,
                            VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name);
  if (!device.is_cpu()) return;
  void* address = nullptr;
  const VkResult mapped = vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &address);
  if (mapped != VK_SUCCESS) device.free(memory_);
  check(mapped, "map shared memory");
  mapped_ = static_cast<std::byte*>(address);
}

MemoryBlock::~MemoryBlock() {
  device_.free(memory_);
}

}  // namespace heliograph::gpu
