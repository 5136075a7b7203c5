#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "protocol/settings/settings.hpp"
#include "render/api/renderer.hpp"

namespace heliograph::cli {

/// With all values of --device as one list.
render::EngineOptions engine_options(const DeviceOptions& options);

/// $XDG_CACHE_HOME/heliograph or ~/.cache/heliograph; empty if neither variable is set.
std::filesystem::path cache_folder();

/// Every device that is meant, set up. A device that is lost meanwhile is set up again, a few
/// times.
/// @throws std::runtime_error
std::vector<std::unique_ptr<render::Engine>> make_engines(const DeviceOptions& options);
/// The first of them alone.
std::unique_ptr<render::Engine> make_engine(const DeviceOptions& options);

/// The defaults with the preset and the "path=value" assignments of the command line.
/// @throws std::invalid_argument
protocol::Settings parse_settings(const SettingsOptions& options);

}  // namespace heliograph::cli
