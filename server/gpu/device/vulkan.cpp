#include "gpu/device/vulkan.hpp"

#include "gpu/device/device_lost.hpp"

namespace heliograph::gpu {

std::string to_string(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "initialisation failed";
    case VK_ERROR_DEVICE_LOST:
      return "device lost";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "no compatible driver";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "feature not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "extension not present";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "format not supported";
    default:
      return "VkResult " + std::to_string(static_cast<int>(result));
  }
}

void check(VkResult result, const char* what) {
  if (result == VK_ERROR_DEVICE_LOST) {
    throw DeviceLost(std::string("could not ") + what + ": " + to_string(result));
  }
  if (result < 0) throw GpuError(std::string("could not ") + what + ": " + to_string(result));
}

}  // namespace heliograph::gpu
