#pragma once

#include <optional>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The light on a node: punctual by KHR_lights_punctual and our extras, or an area by extras alone.
struct NodeLight {
  std::optional<std::uint32_t> punctual;  // index into the document's lights
  std::optional<Light> area;              // shines along the node's -Z; goes before `punctual`
  // Of a directional light, degrees: the sun's from Earth unless the node's extras say otherwise.
  float angular_diameter = 0.53f;
  float radius = 0.0f;  // of a point or spot light, metres; 0: its shadows are hard

  explicit operator bool() const { return punctual || area; }
};

/// @throws ImportError
NodeLight read_node_light(const JsonValue& node, std::size_t light_count);

/// The lights that KHR_lights_punctual declares, still without a place: position at the origin,
/// direction along -Z. @throws ImportError
std::vector<Light> read_lights(const JsonValue& root);

/// The light as a node with this world transform carries it. Sizes do not scale, as
/// KHR_lights_punctual has it for intensities.
shared::Light place_light(shared::Light light, const glm::mat4& world);

/// The light of a node, which has one.
Light place_light(const std::vector<Light>& punctual, const NodeLight& node,
                  const std::string& node_name, const glm::mat4& world);

}  // namespace heliograph::scene
