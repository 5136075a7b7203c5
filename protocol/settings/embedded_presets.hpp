#pragma once

#include <string_view>

namespace heliograph::protocol {

/// The text of scenes/presets/NAME.json, embedded by CMake; empty where there is no such file.
std::string_view embedded_preset(std::string_view name);

}  // namespace heliograph::protocol
