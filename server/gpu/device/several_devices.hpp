#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device/device_choice.hpp"

namespace heliograph::gpu {

/// Every GPU, as a name.
constexpr const char* all_devices = "all";

/// The name of one device for each of `names`, parts of their names; for all_devices those of every
/// GPU, or of every processor where there is no GPU. Of several devices of a name, the one that the
/// names before mean least often. Names without a device stay as they are. `devices` are the
/// reports of a survey, which understands the result.
std::vector<std::string> choose_devices(const std::vector<DeviceReport>& devices,
                                        const std::vector<std::string>& names);

/// From now on Vulkan's functions, which the whole process shares, find the driver by the handle
/// that they are given, as the loader does it; else they are those of the newest device's driver.
/// To be called before the first of several devices is made.
void dispatch_by_handle();
bool dispatches_by_handle();

/// Bytes of the device's own memory that this process may still take, as far as the driver tells.
std::optional<std::uint64_t> free_memory(VkPhysicalDevice device);

}  // namespace heliograph::gpu
