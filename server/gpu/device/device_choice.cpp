#include "gpu/device/device_choice.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <sstream>
#include <system_error>

#include "gpu/device/queues.hpp"
#include "gpu/device/several_devices.hpp"

namespace heliograph::gpu {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

std::vector<std::string> missing_parts(VkPhysicalDevice device, std::uint32_t version) {
  std::vector<std::string> missing;
  if (version < VK_API_VERSION_1_3) {
    missing.push_back("Vulkan 1.3");
    return missing;
  }
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
  vkGetPhysicalDeviceFeatures2(device, &features);
  const auto need = [&](VkBool32 present, const char* name) {
    if (!present) missing.push_back(name);
  };
  need(v13.dynamicRendering, "dynamicRendering");
  need(v13.synchronization2, "synchronization2");
  need(v13.maintenance4, "maintenance4");
  need(v12.bufferDeviceAddress, "bufferDeviceAddress");
  need(v12.hostQueryReset, "hostQueryReset");
  need(features.features.independentBlend, "independentBlend");
  need(features.features.imageCubeArray, "imageCubeArray");
  need(features.features.shaderStorageImageExtendedFormats, "shaderStorageImageExtendedFormats");
  need(has_general_queue(device), "a graphics and compute queue with timestamps");
  return missing;
}

DeviceReport report_on(VkPhysicalDevice device) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
  vkGetPhysicalDeviceProperties2(device, &properties);
  DeviceReport report;
  report.handle = device;
  report.name = properties.properties.deviceName;
  report.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  report.version = version_text(properties.properties.apiVersion);
  report.type = properties.properties.deviceType;
  report.missing = missing_parts(device, properties.properties.apiVersion);
  if (report.missing.empty()) report.rays = find_ray_extensions(device);
  return report;
}

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 1;
    default:
      return 0;
  }
}

/// "Graphics#2": the second device of this name.
struct DeviceName {
  std::string part;
  std::optional<std::size_t> number;  // from 1 on
};

DeviceName parse_name(const std::string& text) {
  const std::size_t mark = text.rfind('#');
  if (mark == std::string::npos) return {text, std::nullopt};
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data() + mark + 1, end, number);
  if (error != std::errc() || last != end || number == 0) return {text, std::nullopt};
  return {text.substr(0, mark), number};
}

bool has_name(const DeviceReport& report, const std::string& part) {
  return lower(report.name).find(lower(part)) != std::string::npos;
}

/// Indices of those that will do and have this part in their name, the best kind first.
std::vector<std::size_t> ranked(const std::vector<DeviceReport>& reports, const std::string& part) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (reports[i].missing.empty() && has_name(reports[i], part)) found.push_back(i);
  }
  std::ranges::stable_sort(found, std::greater<>(),
                           [&](std::size_t i) { return rank(reports[i].type); });
  return found;
}

/// Every manifest the loader would read.
std::vector<std::filesystem::path> driver_files() {
  std::vector<std::filesystem::path> files;
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    const char* value = std::getenv(variable);
    if (!value) continue;
    std::istringstream list(value);
    for (std::string file; std::getline(list, file, ':');) files.emplace_back(file);
    return files;
  }
  for (const char* folder :
       {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Sets an environment variable and puts back what was there.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) before_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

/// Names of the devices that Vulkan finds as the environment stands, or why there is none.
std::string devices_of_this_driver() {
  try {
    const Instance instance(false);
    std::vector<std::string> names;
    for (const VkPhysicalDevice device : instance.devices()) {
      names.push_back(report_on(device).name);
    }
    return names.empty() ? "loads, but finds no device of its kind here" : joined(names);
  } catch (const GpuError& error) {
    return std::string("does not load: ") + error.what();
  }
}

}  // namespace

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other device";
  }
}

std::vector<DeviceReport> survey_devices(const Instance& instance, const std::string& name_part) {
  std::vector<DeviceReport> reports;
  for (const VkPhysicalDevice device : instance.devices()) reports.push_back(report_on(device));
  const DeviceName wanted = parse_name(name_part);
  for (auto& report : reports) {
    if (!report.missing.empty()) {
      report.reason = "not usable: it lacks " + joined(report.missing);
    } else if (!has_name(report, wanted.part)) {
      report.reason = "its name does not contain \"" + wanted.part + "\"";
    }
  }
  // With fewer devices than before a loss, the number counts on from the first.
  const std::vector<std::size_t> found = ranked(reports, wanted.part);
  DeviceReport* const best =
      found.empty() ? nullptr : &reports[found[(wanted.number.value_or(1) - 1) % found.size()]];
  for (auto& report : reports) {
    if (&report == best) {
      report.chosen = true;
      report.reason = name_part.empty() ? "the best kind of device here" : "asked for by name";
    } else if (report.reason.empty() && wanted.number) {
      report.reason = "number " + std::to_string(*wanted.number) + " of this name is meant";
    } else if (report.reason.empty()) {
      report.reason = rank(report.type) == rank(best->type)
                          ? "an equal one comes first"
                          : std::string("a ") + type_name(best->type) + " comes first";
    }
  }
  return reports;
}

std::vector<std::string> choose_devices(const std::vector<DeviceReport>& devices,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> chosen;
  std::vector<std::size_t> taken(devices.size(), 0);  // how often
  const auto take = [&](const std::string& part, const std::vector<std::size_t>& found,
                        std::size_t number) {
    ++taken[found[(number - 1) % found.size()]];
    chosen.push_back(part + "#" + std::to_string(number));
  };
  for (const std::string& name : names) {
    const bool all = name == all_devices;
    const DeviceName wanted = all ? DeviceName() : parse_name(name);
    std::vector<std::size_t> found = ranked(devices, wanted.part);
    if (found.empty()) {
      chosen.push_back(all ? "" : name);
    } else if (all) {
      const auto is_gpu = [&](std::size_t i) {
        return devices[i].type != VK_PHYSICAL_DEVICE_TYPE_CPU;
      };
      const auto gpus = std::ranges::count_if(found, is_gpu);
      // GPUs come first, but for devices of no known kind.
      for (std::size_t number = 1; number <= found.size(); ++number) {
        if (gpus == 0 || is_gpu(found[number - 1])) take("", found, number);
      }
    } else if (wanted.number) {
      take(wanted.part, found, *wanted.number);
    } else {
      const auto least =
          std::ranges::min_element(found, {}, [&](std::size_t i) { return taken[i]; });
      take(wanted.part, found, static_cast<std::size_t>(least - found.begin()) + 1);
    }
  }
  return chosen;
}

std::optional<std::uint64_t> free_memory(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  const bool tells = std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME) == 0;
  });
  if (!tells) return std::nullopt;
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
  VkPhysicalDeviceMemoryProperties2 memory{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
                                           &budget};
  vkGetPhysicalDeviceMemoryProperties2(device, &memory);
  std::uint64_t bytes = 0;
  for (std::uint32_t i = 0; i < memory.memoryProperties.memoryHeapCount; ++i) {
    const VkMemoryHeapFlags flags = memory.memoryProperties.memoryHeaps[i].flags;
    if ((flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) == 0) continue;
    if (budget.heapBudget[i] > budget.heapUsage[i]) {
      bytes += budget.heapBudget[i] - budget.heapUsage[i];
    }
  }
  return bytes;
}

std::vector<DriverReport> examine_driver_files() {
  std::vector<DriverReport> reports;
  for (const auto& file : driver_files()) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
      reports.push_back({file.string(), "no such file"});
      continue;
    }
    const ScopedVariable newer("VK_DRIVER_FILES", file.string());
    const ScopedVariable older("VK_ICD_FILENAMES", file.string());
    reports.push_back({file.string(), devices_of_this_driver()});
  }
  return reports;
}

}  // namespace heliograph::gpu
