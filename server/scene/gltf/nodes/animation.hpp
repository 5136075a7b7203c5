#pragma once

#include <vector>

#include "scene/byte_budget.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// The document's animations of nodes in the scene. Names are made unique; unnamed clips are called
/// "clip N".
/// @throws ImportError
std::vector<Clip> read_clips(const tinygltf::Model& model, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget, Warnings& warnings);

/// The document's skins, in order; a skin with joints outside the scene has no joints.
/// @throws ImportError
std::vector<Skin> read_skins(const tinygltf::Model& model, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget);

}  // namespace heliograph::scene
