#pragma once

#include <glm/glm.hpp>
#include <span>

#include "protocol/settings/settings.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/ground.h"
#include "shaders/shared/scene.h"

namespace heliograph::render {

class MovingScene;
struct UpperLight;

/// Whether shadows fall on a plane under the scene (`background.ground`).
bool catches_shadows(const protocol::Settings& settings, const MovingScene& scene);

/// shared::FrameConstants::ground: under the scene at rest, as wide as its shadows reach in most
/// light.
glm::vec4 ground_plane(const protocol::Settings& settings, const MovingScene& scene);

/// Points of the environment, whose light is `sky`, of its sun and of all lights of the scene that
/// are above the ground, as many of each as its share of the light at the ground's middle. `lights`
/// has shared::ground_lights elements.
void choose_ground_lights(const shared::FrameConstants& frame, const UpperLight& sky,
                          std::span<const shared::Light> scene_lights,
                          std::span<shared::GroundLight> lights);

}  // namespace heliograph::render
