#pragma once

#include <glm/glm.hpp>
#include <span>

#include "protocol/settings/settings.hpp"
#include "shaders/shared/ground.h"

namespace heliograph::render {

class MovingScene;

/// Whether shadows fall on a plane under the scene (`background.ground`).
bool catches_shadows(const protocol::Settings& settings, const MovingScene& scene);

/// shared::FrameConstants::ground: under the scene at rest, as wide as its shadows reach in most
/// light.
glm::vec4 ground_plane(const protocol::Settings& settings, const MovingScene& scene);

/// Points of the environment, of its sun and of all lights of the scene that are above the ground,
/// as many of each as its share of the light at the ground's middle. `lights` has
/// shared::ground_lights elements.
void choose_ground_lights(const protocol::Settings& settings, const MovingScene& scene,
                          std::span<shared::GroundLight> lights);

}  // namespace heliograph::render
