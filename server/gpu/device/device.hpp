#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "gpu/device/device_choice.hpp"
#include "gpu/device/instance.hpp"
#include "gpu/device/priority_mutex.hpp"
#include "gpu/device/queues.hpp"
#include "gpu/pipelines/program_registry.hpp"

namespace heliograph::gpu {

struct DeviceOptions {
  std::string name_part;               // part of the device's name, or empty
  std::filesystem::path cache_folder;  // where the pipeline cache is kept; empty: nowhere
  bool as_gpu = false;                 // a processor too has memory of its own: tests that path
};

/// A logical device with its queues and its pipeline cache.
class Device {
 public:
  /// @throws GpuError listing every device and why it was not chosen
  Device(const Instance& instance, const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return handle_; }
  VkPhysicalDevice physical() const { return report_.handle; }
  const DeviceReport& report() const { return report_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  const Queues& queues() const { return *queues_; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
  bool labels() const { return labels_; }
  ProgramRegistry& programs() const { return programs_; }

  /// The device is this machine's processor: its memory is ours, mapped, and host passes pay off.
  bool is_cpu() const { return report_.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }

  /// Images of VK_FORMAT_BC7_UNORM_BLOCK and VK_FORMAT_BC7_SRGB_BLOCK can be filled and sampled
  /// with filters.
  bool samples_bc7() const { return samples_bc7_; }

  /// Shaders have 64-bit integers, and atomic operations on those of buffers.
  bool atomics_64() const { return atomics_64_; }

  /// Compute shaders can ask which invocations of a subgroup satisfy a condition.
  bool subgroup_ballots() const { return subgroup_ballots_; }

  /// Index of a memory type among `allowed` with `needed`, preferring one that has `preferred` too.
  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags needed,
                            VkMemoryPropertyFlags preferred) const;
  /// Thread safe, like free(). Submits go first.
  VkDeviceMemory allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags needed,
                          VkMemoryPropertyFlags preferred, const std::string& name) const;
  void free(VkDeviceMemory memory) const;

  /// For frames that may submit nothing: finds a device that tests have lost. Thread safe.
  /// @throws DeviceLost
  void check_presence() const;
  /// Submits and returns at once. The device begins when it is done with `after`. Thread safe.
  /// @returns what wait() waits for
  Submission submit(VkCommandBuffer commands, std::uint32_t queue = Queues::general,
                    const std::optional<Submission>& after = {}) const;
  /// Until it is done. Thread safe.
  void wait(const Submission& submission) const;
  /// Records into a fresh command buffer, submits it and waits: for set-up work. Thread safe.
  void submit_once(const std::function<void(VkCommandBuffer)>& record) const;

  void name(VkObjectType type, std::uint64_t object, const std::string& name) const;
  template <typename Handle>
  void name(VkObjectType type, Handle object, const std::string& text) const {
    name(type, reinterpret_cast<std::uint64_t>(object), text);
  }

 private:
  void create(const Instance& instance);
  void load_pipeline_cache(const std::filesystem::path& folder);
  void save_pipeline_cache() const;

  DeviceReport report_;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  VkDevice handle_ = VK_NULL_HANDLE;
  std::optional<Queues> queues_;
  /// A driver does one of both at a time, in no order: NVIDIA's takes 0.07 ms to allocate a
  /// megabyte, and a submit waited for all blocks of a new session.
  mutable PriorityMutex driver_mutex_;
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
  std::filesystem::path cache_file_;
  bool labels_ = false;
  bool samples_bc7_ = false;
  bool atomics_64_ = false;
  bool subgroup_ballots_ = false;
  mutable ProgramRegistry programs_;
};

/// Lets all queues of the device use what is made of `info`, that of a buffer or an image.
template <typename CreateInfo>
void share_between_queues(const Device& device, CreateInfo& info) {
  const std::span<const std::uint32_t> families = device.queues().families();
  if (families.size() < 2) return;
  info.sharingMode = VK_SHARING_MODE_CONCURRENT;
  info.queueFamilyIndexCount = static_cast<std::uint32_t>(families.size());
  info.pQueueFamilyIndices = families.data();
}

/// A full memory barrier between everything before and everything after.
void full_barrier(VkCommandBuffer commands);

}  // namespace heliograph::gpu
