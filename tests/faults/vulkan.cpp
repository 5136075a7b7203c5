// Calls of the Vulkan driver that fail. The program finds the loader with dlsym.
#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <cstring>

#include "fault_table.hpp"

namespace heliograph::faults {
namespace {

/// Stands before a function that returns a VkResult.
template <Function function, class Type>
struct Before;

template <Function function, class... Arguments>
struct Before<function, VkResult(VKAPI_PTR*)(Arguments...)> {
  using Pointer = VkResult(VKAPI_PTR*)(Arguments...);
  static inline std::atomic<Pointer> driver = nullptr;

  static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
    const Outcome outcome = outcome_of(function, [](const char*) { return true; });
    // The driver still has the work: what the program frees must not be in use.
    if (outcome.error != 0 && function != Function::vkWaitSemaphores) {
      return static_cast<VkResult>(outcome.error);
    }
    const VkResult result = driver.load()(arguments...);
    return outcome.error != 0 ? static_cast<VkResult>(outcome.error) : result;
  }
};

/// The function with a fault before it, or the function itself.
PFN_vkVoidFunction with_fault(const char* name, PFN_vkVoidFunction found) {
  if (!found) return found;
#define FUNCTION(name)
#define VULKAN_FUNCTION(entry)                                   \
  if (std::strcmp(name, #entry) == 0) {                          \
    using Wrapped = Before<Function::entry, PFN_##entry>;        \
    Wrapped::driver.store(reinterpret_cast<PFN_##entry>(found)); \
    return reinterpret_cast<PFN_vkVoidFunction>(&Wrapped::call); \
  }
#include "fault_functions.def"
  return found;
}

PFN_vkGetInstanceProcAddr loader_instance = nullptr;
PFN_vkGetDeviceProcAddr loader_device = nullptr;

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
  return with_fault(name, loader_device(device, name));
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction found = loader_instance(instance, name);
  if (found && std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
    loader_device = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(&device_function);
  }
  return with_fault(name, found);
}

using Dlsym = void*(void*, const char*);

Dlsym* next_dlsym() {
  // dlsym itself is found by the one other function that can.
  static Dlsym* const found = reinterpret_cast<Dlsym*>(dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.34"));
  return found;
}

}  // namespace

void* next_function(const char* name) {
  return next_dlsym()(RTLD_NEXT, name);
}

}  // namespace heliograph::faults

extern "C" void* dlsym(void* library, const char* name) noexcept {
  void* const found = heliograph::faults::next_dlsym()(library, name);
  if (!found || std::strcmp(name, "vkGetInstanceProcAddr") != 0) return found;
  // Layers and drivers look it up, too; the program is the first.
  if (heliograph::faults::loader_instance) return found;
  heliograph::faults::loader_instance = reinterpret_cast<PFN_vkGetInstanceProcAddr>(found);
  return reinterpret_cast<void*>(&heliograph::faults::instance_function);
}
