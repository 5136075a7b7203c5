#pragma once

#include <optional>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The light on a node: a punctual light (KHR_lights_punctual and our extras) or an area light
/// (extras).
struct NodeLight {
  std::optional<std::uint32_t> punctual;  // index into the document's lights
  std::optional<Light> area;  // emits along the node's -Z; takes precedence over `punctual`
  // Of a directional light, degrees; default: the sun seen from Earth.
  float angular_diameter = 0.53f;
  float radius = 0.0f;  // of a point or spot light, metres; 0: hard shadows

  explicit operator bool() const { return punctual || area; }
};

NodeLight read_node_light(const tinygltf::Node& node, const std::string& path);

/// The lights of KHR_lights_punctual, before they are placed by nodes: at the origin, direction -Z.
/// @throws ImportError
std::vector<Light> read_lights(const tinygltf::Model& model);

/// The light in world space, attached to a node with this world transform. Sizes do not scale, like
/// intensities in KHR_lights_punctual.
shared::Light place_light(shared::Light light, const glm::mat4& world);

/// The light of a node; the node must have one.
Light place_light(const std::vector<Light>& punctual, const NodeLight& node,
                  const std::string& node_name, const glm::mat4& world);

}  // namespace heliograph::scene
