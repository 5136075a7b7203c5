#pragma once

#include "cli/options.hpp"
#include "protocol/settings/settings.hpp"
#include "render/api/renderer.hpp"

namespace heliograph::cli {

render::EngineOptions engine_options(const DeviceOptions& options);

/// The defaults with the preset and the "path=value" assignments of the command line.
/// @throws std::invalid_argument
protocol::Settings parse_settings(const SettingsOptions& options);

}  // namespace heliograph::cli
