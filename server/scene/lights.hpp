#pragma once

#include <vector>

#include "scene/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The lights that KHR_lights_punctual declares, still without a place: position at the origin,
/// direction along -Z. @throws ImportError
std::vector<Light> read_lights(const JsonValue& root);

/// `light` as the node with this world transform carries it. A directional light subtends
/// `angular_diameter` degrees.
Light place_light(Light light, const std::string& node_name, const glm::mat4& world,
                  float angular_diameter);

}  // namespace heliograph::scene
