#pragma once

#include <memory>

#include "scene/scene.hpp"

namespace heliograph::test {

/// Quads with a texture in every slot and a sphere: tilted, mirrored, non-uniformly scaled, and
/// seen from behind.
std::shared_ptr<const scene::Scene> textured_scene();

/// Every kind of surface that rays may pass through, in front of a wall.
std::shared_ptr<const scene::Scene> transparent_scene();

}  // namespace heliograph::test
