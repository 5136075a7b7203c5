#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device/instance.hpp"
#include "gpu/device/ray_extensions.hpp"

namespace heliograph::gpu {

/// Properties of one physical device, and whether it was chosen.
struct DeviceReport {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  std::string name;
  std::string driver;   // name and version
  std::string version;  // of Vulkan, "1.3.230"
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::vector<std::string> missing;  // what it lacks; empty: it will do
  RayExtensions rays;                // of a device that will do
  bool chosen = false;
  std::string reason;  // why it was or was not chosen, one sentence
};

/// Looks at every device and chooses one: a name containing `name_part` (ignoring case), otherwise
/// a discrete GPU before an integrated, a virtual one, a CPU. Reports come in the loader's order.
std::vector<DeviceReport> survey_devices(const Instance& instance, const std::string& name_part);

/// What one driver file (ICD manifest) brings.
struct DriverReport {
  std::string file;
  std::string verdict;  // its devices' names, or why there is none
};

/// Starts Vulkan with each driver file alone and tells what came of it, in the loader's order.
/// Changes VK_DRIVER_FILES while it runs: for the doctor's single thread only.
std::vector<DriverReport> examine_driver_files();

const char* type_name(VkPhysicalDeviceType type);

}  // namespace heliograph::gpu
