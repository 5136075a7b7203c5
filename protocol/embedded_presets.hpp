#pragma once

#include <span>
#include <string_view>

namespace heliograph::protocol {

struct EmbeddedPreset {
  std::string_view name;
  std::string_view text;  // of the JSON file
};

/// Made by CMake from scenes/presets, in the order of the ladder.
std::span<const EmbeddedPreset> embedded_presets();

}  // namespace heliograph::protocol
