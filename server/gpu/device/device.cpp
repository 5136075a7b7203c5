#include "gpu/device/device.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <vector>

#include "gpu/device/several_devices.hpp"

namespace heliograph::gpu {
namespace {

std::string refusal(const std::vector<DeviceReport>& reports) {
  if (reports.empty()) {
    return "no Vulkan device: install a driver (mesa-vulkan-drivers has one for machines "
           "without a GPU)";
  }
  std::string text = "no Vulkan device will do:";
  for (const auto& report : reports) text += " " + report.name + " (" + report.reason + ");";
  text.back() = '.';
  return text;
}

/// Hexadecimal name of the pipeline cache this exact driver can read.
std::string cache_name(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device, &properties);
  std::string name = "pipelines-";
  for (const std::uint8_t byte : properties.pipelineCacheUUID) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    name += digits;
  }
  return name + ".bin";
}

bool fills_and_filters(VkPhysicalDevice device, VkFormat format) {
  constexpr VkFormatFeatureFlags needed =
      VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
      VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  return (properties.optimalTilingFeatures & needed) == needed;
}

void destroy(VkDevice device, VkPipelineCache cache) {
  if (!device) return;
  vkDestroyPipelineCache(device, cache, nullptr);
  vkDestroyDevice(device, nullptr);
}

/// Lets tests lose the device: once for each time that they make the file that this names.
bool loss_is_wanted() {
  const char* const file = std::getenv("HELIOGRAPH_TEST_DEVICE_LOSS");
  return file && std::remove(file) == 0;
}

bool has_subgroup_ballots(VkPhysicalDevice device) {
  VkPhysicalDeviceVulkan11Properties subgroups{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         &subgroups};
  vkGetPhysicalDeviceProperties2(device, &properties);
  constexpr VkSubgroupFeatureFlags needed =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  return (subgroups.subgroupSupportedOperations & needed) == needed &&
         (subgroups.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
}

}  // namespace

Device::Device(const Instance& instance, const DeviceOptions& options) {
  const auto reports = survey_devices(instance, options.name_part);
  for (const auto& report : reports) {
    if (report.chosen) report_ = report;
  }
  if (!report_.chosen) throw GpuError(refusal(reports));
  if (options.as_gpu) report_.type = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  try {
    create(instance);
    load_pipeline_cache(options.cache_folder);
  } catch (...) {
    queues_.reset();  // what was made before the step that failed
    destroy(handle_, pipeline_cache_);
    throw;
  }
}

Device::~Device() {
  vkDeviceWaitIdle(handle_);
  try {
    save_pipeline_cache();
  } catch (const std::exception&) {
    // There is no memory for it: the next start compiles the pipelines again.
  }
  queues_.reset();
  destroy(handle_, pipeline_cache_);
}

void Device::create(const Instance& instance) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(report_.handle, &properties);
  limits_ = properties.limits;
  vkGetPhysicalDeviceMemoryProperties(report_.handle, &memory_);
  queues_.emplace(report_.handle, is_cpu());
  labels_ = instance.labels();

  const RayFeatures rays(report_.rays);
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                       rays.chain()};
  v13.dynamicRendering = VK_TRUE;
  v13.synchronization2 = VK_TRUE;
  v13.maintenance4 = VK_TRUE;  // the compiler writes LocalSizeId
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
  v12.bufferDeviceAddress = VK_TRUE;
  v12.hostQueryReset = VK_TRUE;
  v12.timelineSemaphore = VK_TRUE;
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
  features.features.independentBlend = VK_TRUE;
  features.features.imageCubeArray = VK_TRUE;
  features.features.shaderStorageImageExtendedFormats = VK_TRUE;
  VkPhysicalDeviceVulkan12Features supported_12{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceFeatures2 all_supported{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          &supported_12};
  vkGetPhysicalDeviceFeatures2(report_.handle, &all_supported);
  const VkPhysicalDeviceFeatures& supported = all_supported.features;
  features.features.samplerAnisotropy = supported.samplerAnisotropy;
  features.features.textureCompressionBC = supported.textureCompressionBC;
  samples_bc7_ = supported.textureCompressionBC &&
                 fills_and_filters(report_.handle, VK_FORMAT_BC7_UNORM_BLOCK) &&
                 fills_and_filters(report_.handle, VK_FORMAT_BC7_SRGB_BLOCK);
  atomics_64_ = supported.shaderInt64 && supported_12.shaderBufferInt64Atomics;
  features.features.shaderInt64 = atomics_64_;
  v12.shaderBufferInt64Atomics = atomics_64_;
  subgroup_ballots_ = has_subgroup_ballots(report_.handle);
  features.features.robustBufferAccess = instance.validation() ? supported.robustBufferAccess : 0;

  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
  info.queueCreateInfoCount = static_cast<std::uint32_t>(queues_->create_infos().size());
  info.pQueueCreateInfos = queues_->create_infos().data();
  info.enabledExtensionCount = static_cast<std::uint32_t>(rays.extensions().size());
  info.ppEnabledExtensionNames = rays.extensions().data();
  check(vkCreateDevice(report_.handle, &info, nullptr, &handle_), "create the Vulkan device");
  if (!dispatches_by_handle()) volkLoadDevice(handle_);
  queues_->open(handle_);
}

void Device::load_pipeline_cache(const std::filesystem::path& folder) {
  std::vector<char> bytes;
  if (!folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    cache_file_ = folder / cache_name(report_.handle);
    std::ifstream file(cache_file_, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  // The driver checks the header itself and starts empty when the bytes are not its own.
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = bytes.size();
  info.pInitialData = bytes.data();
  check(vkCreatePipelineCache(handle_, &info, nullptr, &pipeline_cache_),
        "create the pipeline cache");
}

void Device::save_pipeline_cache() const {
  if (cache_file_.empty()) return;
  std::size_t size = 0;
  if (vkGetPipelineCacheData(handle_, pipeline_cache_, &size, nullptr) != VK_SUCCESS) return;
  std::vector<char> bytes(size);
  if (vkGetPipelineCacheData(handle_, pipeline_cache_, &size, bytes.data()) != VK_SUCCESS) return;
  // Another device may have the same file.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  // Written beside and moved over, so that a second process never reads half a file.
  const auto temporary = cache_file_.string() + ".new";
  std::ofstream file(temporary, std::ios::binary);
  file.write(bytes.data(), static_cast<long>(size));
  file.close();
  std::error_code error;
  if (file) {
    std::filesystem::rename(temporary, cache_file_, error);
  } else {
    std::filesystem::remove(temporary, error);  // the disk is full
  }
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags needed,
                                  VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {needed | preferred, needed}) {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
      const bool fits = (memory_.memoryTypes[i].propertyFlags & flags) == flags;
      if ((allowed & (1u << i)) && fits) return i;
    }
  }
  throw GpuError("the device has no memory of the kind needed");
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& requirements,
                                VkMemoryPropertyFlags needed, VkMemoryPropertyFlags preferred,
                                const std::string& name) const {
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
  info.allocationSize = requirements.size;
  info.memoryTypeIndex = memory_type(requirements.memoryTypeBits, needed, preferred);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const std::string what = "allocate " + std::to_string(requirements.size) + " bytes for " + name;
  const auto lock = driver_mutex_.lock_after();
  check(vkAllocateMemory(handle_, &info, nullptr, &memory), what.c_str());
  return memory;
}

void Device::free(VkDeviceMemory memory) const {
  if (!memory) return;
  const auto lock = driver_mutex_.lock_after();
  vkFreeMemory(handle_, memory, nullptr);
}

void Device::check_presence() const {
  check(loss_is_wanted() ? VK_ERROR_DEVICE_LOST : VK_SUCCESS, "reach the device");
}

Submission Device::submit(VkCommandBuffer commands, std::uint32_t queue,
                          const std::optional<Submission>& after) const {
  check_presence();
  const auto lock = driver_mutex_.lock_first();
  return queues_->submit(commands, queue, after);
}

void Device::wait(const Submission& submission) const {
  while (!queues_->wait_for(submission, std::chrono::hours(1))) continue;
}

void Device::submit_once(const std::function<void(VkCommandBuffer)>& record) const {
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.queueFamilyIndex = queues_->family(Queues::general);
  pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(handle_, &pool_info, nullptr, &pool), "create a command pool");
  struct PoolGuard {
    VkDevice device;
    VkCommandPool pool;
    ~PoolGuard() { vkDestroyCommandPool(device, pool, nullptr); }
  } guard{handle_, pool};
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(handle_, &info, &commands), "allocate a command buffer");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "begin a command buffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "end a command buffer");
  wait(submit(commands));
}

void Device::name(VkObjectType type, std::uint64_t object, const std::string& text) const {
  if (!labels_) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = text.c_str();
  vkSetDebugUtilsObjectNameEXT(handle_, &info);
}

void full_barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace heliograph::gpu
