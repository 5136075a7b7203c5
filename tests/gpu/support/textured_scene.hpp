#pragma once

#include <memory>

#include "scene/scene.hpp"

namespace heliograph::test {

/// Quads with a texture in every slot and a sphere: tilted, mirrored, non-uniformly scaled, and
/// seen from behind.
std::shared_ptr<const scene::Scene> textured_scene();

}  // namespace heliograph::test
