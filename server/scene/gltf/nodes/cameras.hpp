#pragma once

#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The document's cameras, still without a place. @throws ImportError
std::vector<Camera> read_cameras(const JsonValue& root);

/// `camera` as the node with this world transform carries it: it looks along the node's -Z. The
/// target lies on that axis as far out as the middle of `bounds`, at least 0.1 m away.
Camera place_camera(Camera camera, const std::string& node_name, const glm::mat4& world,
                    const Bounds& bounds);

}  // namespace heliograph::scene
