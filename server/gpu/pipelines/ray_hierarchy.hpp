#pragma once

#include "gpu/memory/buffer.hpp"

namespace heliograph::gpu {

/// One level of a hierarchy that the driver builds and walks itself (VkAccelerationStructureKHR),
/// in a buffer of the caller's that outlives it.
class RayHierarchy {
 public:
  RayHierarchy() = default;
  RayHierarchy(const Device& device, VkAccelerationStructureTypeKHR type, const Buffer& memory,
               VkDeviceSize offset, VkDeviceSize size);
  ~RayHierarchy();
  RayHierarchy(RayHierarchy&& other) noexcept { swap(other); }
  RayHierarchy& operator=(RayHierarchy&& other) noexcept {
    swap(other);
    return *this;
  }

  VkAccelerationStructureKHR handle() const { return handle_; }
  /// Where rays enter it. 0: there is none.
  VkDeviceAddress address() const { return address_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

 private:
  void swap(RayHierarchy& other) noexcept;

  const Device* device_ = nullptr;
  VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
};

}  // namespace heliograph::gpu
