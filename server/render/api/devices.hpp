#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/api/engine.hpp"

namespace heliograph::render {

/// Those of a server, by the index of their device.
using Engines = std::vector<std::reference_wrapper<Engine>>;

/// The names in a list: between commas, but for those in parentheses, which belong to a name.
std::vector<std::string> device_names(std::string_view list);

/// Options for an engine on each device that the list in `options` means (gpu::choose_devices), all
/// of which may be used at once. An empty list means the best device. A name without a device is
/// left to the engine's constructor.
/// @throws gpu::GpuError
std::vector<EngineOptions> choose_devices(const EngineOptions& options);

/// Bytes of the device's own memory that may still be taken, as far as it tells. For the thread
/// that may recreate the device.
std::optional<std::uint64_t> free_memory(Engine& engine);

}  // namespace heliograph::render
