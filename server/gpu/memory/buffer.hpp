#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/memory/memory_block.hpp"

namespace heliograph::gpu {

/// Where a buffer lives. On a CPU device every buffer is mapped.
enum class Memory {
  device,    // fastest for the device
  upload,    // mapped, written by the host
  readback,  // mapped and cached, read by the host
};

/// A buffer with its own memory, or in a block of several. Every buffer may be copied from and to.
class Buffer {
 public:
  Buffer() = default;
  /// `place`: in a block, mapped, whatever `memory` says.
  Buffer(const Device& device, std::string name, VkDeviceSize size, VkBufferUsageFlags usage,
         Memory memory, MemoryPlace place = {});
  /// The same buffer once more, which stays as long as either of both.
  explicit Buffer(std::shared_ptr<const Buffer> shared);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// What a block needs to hold a buffer of `size` bytes.
  static VkMemoryRequirements requirements(const Device& device, VkDeviceSize size,
                                           VkBufferUsageFlags usage);

  VkBuffer handle() const { return handle_; }
  VkDeviceSize size() const { return size_; }
  const std::string& name() const { return name_; }
  /// The block in which the buffer lies, or null, and bytes of memory that it has for itself.
  const MemoryBlock* block() const { return block_.get(); }
  VkDeviceSize own_bytes() const { return block_ || shared_ ? 0 : size_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  /// The buffer's bytes, or null when the host cannot reach them.
  std::byte* mapped() const { return mapped_; }

  /// Where shaders and builds find the bytes. The buffer's usage must allow for it.
  VkDeviceAddress address() const;

  /// A view for uniform texel buffers, made at the first call and kept. Not thread safe.
  VkBufferView texel_view(VkFormat format) const;

 private:
  void swap(Buffer& other) noexcept;

  const Device* device_ = nullptr;
  std::string name_;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;  // its own
  std::shared_ptr<const MemoryBlock> block_;
  std::shared_ptr<const Buffer> shared_;  // whose handle this is; null: its own
  mutable VkBufferView view_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  std::byte* mapped_ = nullptr;
};

/// A device buffer holding a copy of `bytes` (at least 16 bytes long, so that empty tables bind).
Buffer upload_buffer(const Device& device, std::string name, std::span<const std::byte> bytes,
                     VkBufferUsageFlags usage);

/// Copies the first `size` bytes back. Waits for the device.
std::vector<std::byte> download_buffer(const Device& device, const Buffer& buffer,
                                       std::size_t size);

}  // namespace heliograph::gpu
