#pragma once

#include <span>
#include <string_view>

#include "protocol/json/raw_json.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// A named choice of settings for the whole denoiser: scenes/presets/*.json, embedded in the
/// program.
struct Preset {
  std::string_view name;
  std::string_view description;
  RawJson settings;  // a patch as settings.patch takes it
};

/// The paper's ladder from `svgf` to `reinhard`, each on top of the last, then `best`. Every preset
/// names the same settings, so that whatever another one chose is undone.
std::span<const Preset> presets();

/// ErrorCode::not_found with the nearest name.
Result<Preset> find_preset(std::string_view name);

}  // namespace heliograph::protocol
