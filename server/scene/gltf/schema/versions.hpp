#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Accepts glTF 2.x whose required extensions are supported. Other extensions in use are ignored,
/// with a warning for each.
/// @throws ImportError
void check_versions(const nlohmann::json& document, Warnings& warnings);

}  // namespace heliograph::scene
