#include "gpu/memory/buffer.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace heliograph::gpu {
namespace {

VkBufferCreateInfo buffer_info(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  // Whole texels of any format, so that a view covers the last bytes too.
  info.size = std::max<VkDeviceSize>((size + 15) / 16 * 16, 16);
  info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  share_between_queues(device, info);
  return info;
}

}  // namespace

VkMemoryRequirements Buffer::requirements(const Device& device, VkDeviceSize size,
                                          VkBufferUsageFlags usage) {
  const VkBufferCreateInfo made = buffer_info(device, size, usage);
  VkDeviceBufferMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
  info.pCreateInfo = &made;
  VkMemoryRequirements2 found{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceBufferMemoryRequirements(device.handle(), &info, &found);
  return found.memoryRequirements;
}

Buffer::Buffer(const Device& device, std::string name, VkDeviceSize size, VkBufferUsageFlags usage,
               Memory memory, MemoryPlace place)
    : Buffer() {  // what is made is the destructor's when a step fails
  device_ = &device;
  name_ = std::move(name);
  const VkBufferCreateInfo info = buffer_info(device, size, usage);
  size_ = info.size;
  check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "create a buffer");
  device.name(VK_OBJECT_TYPE_BUFFER, handle_, name_);
  if (place.block) {
    block_ = std::move(place.block);
    check(vkBindBufferMemory(device.handle(), handle_, block_->handle(), place.offset),
          "bind a buffer's place");
    mapped_ = block_->mapped(place.offset);
    return;
  }
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device.handle(), handle_, &requirements);
  constexpr VkMemoryPropertyFlags mapped =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryPropertyFlags needed = memory == Memory::device && !device.is_cpu() ? 0 : mapped;
  VkMemoryPropertyFlags preferred = memory == Memory::readback
                                        ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                        : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  memory_ = device.allocate(requirements, needed, preferred, name_);
  check(vkBindBufferMemory(device.handle(), handle_, memory_, 0), "bind a buffer's memory");
  if (needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
    void* address = nullptr;
    check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &address), "map a buffer");
    mapped_ = static_cast<std::byte*>(address);
  }
}

Buffer::Buffer(std::shared_ptr<const Buffer> shared)
    : device_(shared->device_),
      name_(shared->name_),
      handle_(shared->handle_),
      block_(shared->block_),
      shared_(std::move(shared)),
      size_(shared_->size_),
      mapped_(shared_->mapped_) {}

Buffer::~Buffer() {
  if (!device_) return;
  vkDestroyBufferView(device_->handle(), view_, nullptr);
  if (shared_) return;
  vkDestroyBuffer(device_->handle(), handle_, nullptr);
  device_->free(memory_);
}

void Buffer::swap(Buffer& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(name_, other.name_);
  std::swap(handle_, other.handle_);
  std::swap(memory_, other.memory_);
  std::swap(block_, other.block_);
  std::swap(shared_, other.shared_);
  std::swap(view_, other.view_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
}

VkDeviceAddress Buffer::address() const {
  VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  info.buffer = handle_;
  return vkGetBufferDeviceAddress(device_->handle(), &info);
}

VkBufferView Buffer::texel_view(VkFormat format) const {
  if (view_) return view_;
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = handle_;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  check(vkCreateBufferView(device_->handle(), &info, nullptr, &view_), "create a texel view");
  return view_;
}

Buffer upload_buffer(const Device& device, std::string name, std::span<const std::byte> bytes,
                     VkBufferUsageFlags usage) {
  Buffer buffer(device, std::move(name), bytes.size(), usage, Memory::device);
  if (bytes.empty()) return buffer;
  if (buffer.mapped()) {
    std::memcpy(buffer.mapped(), bytes.data(), bytes.size());
    return buffer;
  }
  const Buffer staging(device, "staging", bytes.size(), 0, Memory::upload);
  std::memcpy(staging.mapped(), bytes.data(), bytes.size());
  device.submit_once([&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 0, bytes.size()};
    vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &region);
    full_barrier(commands);
  });
  return buffer;
}

std::vector<std::byte> download_buffer(const Device& device, const Buffer& buffer,
                                       std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (buffer.mapped()) {
    std::memcpy(bytes.data(), buffer.mapped(), size);
    return bytes;
  }
  const Buffer staging(device, buffer.name() + " download", size, 0, Memory::readback);
  device.submit_once([&](VkCommandBuffer commands) {
    full_barrier(commands);
    const VkBufferCopy region{0, 0, size};
    vkCmdCopyBuffer(commands, buffer.handle(), staging.handle(), 1, &region);
  });
  std::memcpy(bytes.data(), staging.mapped(), size);
  return bytes;
}

}  // namespace heliograph::gpu
