#pragma once

#include <span>
#include <string_view>

#include "protocol/json/raw_json.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// A named configuration of the denoiser: scenes/presets/*.json, embedded in the program. A file
/// holds only what it changes: settings that differ from the defaults or, with "extends", from
/// those of another preset.
struct Preset {
  std::string_view name;
  std::string_view description;
  /// A patch for apply_patch: first resets all settings of the denoiser (null), whatever a user or
  /// another preset had changed, and then sets those of the preset.
  RawJson settings;
};

/// The steps of the paper, `svgf` to `reinhard`, each of which extends the one before, then `best`,
/// the defaults.
std::span<const Preset> presets();

/// ErrorCode::not_found with the nearest name.
Result<Preset> find_preset(std::string_view name);

}  // namespace heliograph::protocol
