#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "session/library/scene_catalogue.hpp"

namespace heliograph::cli {

/// The given folders; otherwise the first default folder with a scene in it, of the build or of the
/// installation. Empty if there is none.
std::vector<std::filesystem::path> choose_scene_roots(
    const std::vector<std::filesystem::path>& given);

/// `requested`; otherwise the demo scene, otherwise the first scene, otherwise nothing.
/// @throws std::runtime_error if there is no such scene
std::optional<std::string> choose_scene(const session::SceneCatalogue& catalogue,
                                        const std::string& requested);

}  // namespace heliograph::cli
