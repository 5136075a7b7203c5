#pragma once

#include <cstdint>

#include "gpu/device/device.hpp"
#include "gpu/device/vulkan.hpp"
#include "gpu/memory/buffer.hpp"

namespace heliograph::gpu {

/// Commands that fill `buffer` with `word`, for one queue.
class Filling {
 public:
  Filling(const Device& device, std::uint32_t queue, const Buffer& buffer, std::uint32_t word)
      : device_(device) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queues().family(queue);
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "create a command pool");
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = pool_;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &info, &commands), "allocate commands");
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin), "begin commands");
    vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, word);
    check(vkEndCommandBuffer(commands), "end commands");
  }
  ~Filling() { vkDestroyCommandPool(device_.handle(), pool_, nullptr); }
  Filling(const Filling&) = delete;
  Filling& operator=(const Filling&) = delete;

  VkCommandBuffer commands = VK_NULL_HANDLE;

 private:
  const Device& device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

}  // namespace heliograph::gpu
