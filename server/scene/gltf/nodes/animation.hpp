#pragma once

#include <vector>

#include "scene/byte_budget.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// The document's animations, as far as they move nodes that are shown. Names are unique, so that
/// each can be asked for; what has none is called "clip" and a number.
/// @throws ImportError
std::vector<Clip> read_clips(const JsonValue& root, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget, Warnings& warnings);

/// The document's skins, in its order; one whose joints are not all shown comes out without joints.
/// @throws ImportError
std::vector<Skin> read_skins(const JsonValue& root, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget);

}  // namespace heliograph::scene
