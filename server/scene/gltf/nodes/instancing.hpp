#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The instance transforms of EXT_mesh_gpu_instancing, relative to the node; empty without the
/// extension. At most `limit`.
/// @throws ImportError
std::optional<std::vector<Transform>> read_instancing(const tinygltf::Node& node,
                                                      const std::string& path,
                                                      std::span<const Accessor> accessors,
                                                      std::uint64_t limit);

}  // namespace heliograph::scene
