#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session/library/scene_catalogue.hpp"

namespace heliograph::cli {

/// The folders given, else the first with a scene in it of those where scenes are kept: that of the
/// build, or beside the executable. Empty if there is none.
std::vector<std::filesystem::path> choose_scene_roots(
    const std::vector<std::filesystem::path>& given);

/// `wanted`, else the demo scene, else the first there is.
/// @throws std::runtime_error telling how to make one when there is none
std::string choose_scene(const session::SceneCatalogue& catalogue, const std::string& wanted);

}  // namespace heliograph::cli
