#pragma once

#include <vector>

#include "scene/byte_budget.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

struct Animations {
  std::vector<Clip> clips;
  std::vector<AnimatedSlot> slots;
};

/// The document's animations of the scene. Names are made unique; unnamed clips are called
/// "clip N". Pointers to what cannot be animated are left out with a warning, or refused where the
/// document requires KHR_animation_pointer.
/// @throws ImportError
Animations read_animations(const tinygltf::Model& model, std::span<const Accessor> accessors,
                           const NodeTable& nodes, ByteBudget& budget, Warnings& warnings);

/// The document's skins, in order; a skin with joints outside the scene has no joints.
/// @throws ImportError
std::vector<Skin> read_skins(const tinygltf::Model& model, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget);

}  // namespace heliograph::scene
