#include "gpu/device/instance.hpp"

#include <cstdio>
#include <cstring>
#include <mutex>

#include "gpu/device/several_devices.hpp"

namespace heliograph::gpu {
namespace {

template <typename Properties, typename Call>
std::vector<Properties> enumerate(Call call) {
  std::uint32_t count = 0;
  if (call(&count, nullptr) < 0) return {};
  std::vector<Properties> found(count);
  call(&count, found.data());
  found.resize(count);
  return found;
}

bool has_layer(const char* name) {
  for (const auto& layer : enumerate<VkLayerProperties>(vkEnumerateInstanceLayerProperties)) {
    if (std::strcmp(layer.layerName, name) == 0) return true;
  }
  return false;
}

bool has_extension(const char* name) {
  const auto found =
      enumerate<VkExtensionProperties>([](std::uint32_t* count, VkExtensionProperties* out) {
        return vkEnumerateInstanceExtensionProperties(nullptr, count, out);
      });
  for (const auto& extension : found) {
    if (std::strcmp(extension.extensionName, name) == 0) return true;
  }
  return false;
}

bool by_handle = false;

/// By handle, other threads may call what was found, so that it is written once.
bool find_loader() {
  if (!by_handle) return volkInitialize() == VK_SUCCESS;
  static const bool found = volkInitialize() == VK_SUCCESS;
  return found;
}

void load_functions(VkInstance instance) {
  if (!by_handle) return volkLoadInstanceOnly(instance);
  static std::once_flag once;
  std::call_once(once, [&] { volkLoadInstance(instance); });
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Instance* instance) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = Instance::on_message;
  info.pUserData = instance;
  return info;
}

}  // namespace

void dispatch_by_handle() {
  by_handle = true;
}

bool dispatches_by_handle() {
  return by_handle;
}

Instance::Instance(bool validation) : validation_(validation) {
  if (!find_loader()) {
    throw GpuError("no Vulkan loader (libvulkan.so.1) on this machine: install libvulkan1");
  }
  const char* layer = "VK_LAYER_KHRONOS_validation";
  if (validation && !has_layer(layer)) {
    throw GpuError(
        "the Vulkan validation layers were asked for but are not installed: "
        "install vulkan-validationlayers");
  }
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "heliograph";
  application.apiVersion = VK_API_VERSION_1_3;
  labels_ = has_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = labels_ ? 1 : 0;
  info.ppEnabledExtensionNames = &extension;
  info.enabledLayerCount = validation ? 1 : 0;
  info.ppEnabledLayerNames = &layer;
  check(vkCreateInstance(&info, nullptr, &handle_), "create a Vulkan instance");
  load_functions(handle_);
  if (validation && labels_) {
    const auto messenger = messenger_info(this);
    check(vkCreateDebugUtilsMessengerEXT(handle_, &messenger, nullptr, &messenger_),
          "create the validation messenger");
  }
}

Instance::~Instance() {
  if (messenger_) vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
  if (handle_) vkDestroyInstance(handle_, nullptr);
}

std::vector<VkPhysicalDevice> Instance::devices() const {
  return enumerate<VkPhysicalDevice>([this](std::uint32_t* count, VkPhysicalDevice* out) {
    return vkEnumeratePhysicalDevices(handle_, count, out);
  });
}

VkBool32 Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                              VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<Instance*>(user)->messages_ += 1;
  std::fprintf(stderr, "vulkan: %s\n", data->pMessage);
  return VK_FALSE;
}

}  // namespace heliograph::gpu
