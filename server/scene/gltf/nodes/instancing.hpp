#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/json_value.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// Where EXT_mesh_gpu_instancing puts the mesh of a node, relative to the node; nothing without the
/// extension. No more than `limit`.
/// @throws ImportError
std::optional<std::vector<Transform>> read_instancing(const JsonValue& node,
                                                      std::span<const Accessor> accessors,
                                                      std::uint64_t limit);

}  // namespace heliograph::scene
