#pragma once

#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The document's cameras, before they are placed by nodes. @throws ImportError
std::vector<Camera> read_cameras(const tinygltf::Model& model);

/// Makes the names of a scene's cameras unique, so that each can be chosen; unnamed ones are called
/// "camera 1", by their place in the list.
void name_apart(std::vector<Camera>& cameras);

/// `camera` in world space, attached to a node with this world transform: it looks along the node's
/// -Z. The target is on that axis at the depth of the center of `bounds`, at least 0.1 m away.
Camera place_camera(Camera camera, const std::string& node_name, const glm::mat4& world,
                    const Bounds& bounds);

}  // namespace heliograph::scene
