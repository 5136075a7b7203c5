#pragma once

#include <span>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"

namespace heliograph::scene {

/// Checks the parts of a document that a still picture does not need, skins and animations, so that
/// a damaged file is refused as a whole.
/// @throws ImportError
void check_skins(const JsonValue& root, std::span<const Accessor> accessors);
void check_animations(const JsonValue& root, std::span<const Accessor> accessors);

}  // namespace heliograph::scene
