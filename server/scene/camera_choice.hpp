#pragma once

#include <string_view>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// The scene's camera of this name, or else of this number, counted from 1. Null if there is none.
const Camera* find_camera(const Scene& scene, std::string_view name);

}  // namespace heliograph::scene
