#pragma once

#include <span>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"

namespace heliograph::scene {

/// Checks skins and animations, which are read later, so that a damaged file is rejected early.
/// @throws ImportError
void check_skins(const tinygltf::Model& model, std::span<const Accessor> accessors);
void check_animations(const tinygltf::Model& model, std::span<const Accessor> accessors);

}  // namespace heliograph::scene
