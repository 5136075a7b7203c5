#include "gpu/pipelines/ray_hierarchy.hpp"

#include <utility>

namespace heliograph::gpu {

RayHierarchy::RayHierarchy(const Device& device, VkAccelerationStructureTypeKHR type,
                           const Buffer& memory, VkDeviceSize offset, VkDeviceSize size)
    : device_(&device) {
  VkAccelerationStructureCreateInfoKHR info{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
  info.buffer = memory.handle();
  info.offset = offset;
  info.size = size;
  info.type = type;
  check(vkCreateAccelerationStructureKHR(device.handle(), &info, nullptr, &handle_),
        "create an acceleration structure");
  VkAccelerationStructureDeviceAddressInfoKHR where{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
  where.accelerationStructure = handle_;
  address_ = vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &where);
  device.name(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, handle_, memory.name());
}

RayHierarchy::~RayHierarchy() {
  if (device_) vkDestroyAccelerationStructureKHR(device_->handle(), handle_, nullptr);
}

void RayHierarchy::swap(RayHierarchy& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(address_, other.address_);
}

}  // namespace heliograph::gpu
