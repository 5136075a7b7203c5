#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/device/vulkan.hpp"

namespace heliograph::gpu {

/// The Vulkan loader's instance: headless, 1.3. With validation, every message of the layers is
/// written to stderr and counted.
class Instance {
 public:
  /// @throws GpuError when there is no loader, no driver or no validation layer
  explicit Instance(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  bool labels() const { return labels_; }
  bool validation() const { return validation_; }
  std::uint64_t validation_messages() const { return messages_; }
  std::vector<VkPhysicalDevice> devices() const;

  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                   VkDebugUtilsMessageTypeFlagsEXT types,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                   void* user);

 private:
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  bool validation_ = false;
  bool labels_ = false;
  std::atomic<std::uint64_t> messages_{0};
};

}  // namespace heliograph::gpu
