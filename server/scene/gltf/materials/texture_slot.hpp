#pragma once

#include "scene/gltf/document/json_value.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// A textureInfo of a material: the texture registered in `textures` as colour (sRGB) or data, its
/// set of coordinates and its transform.
/// @throws ImportError
shared::TextureSlot read_texture_slot(const JsonValue& json, bool srgb, TextureTable& textures,
                                      Warnings& warnings);

}  // namespace heliograph::scene
