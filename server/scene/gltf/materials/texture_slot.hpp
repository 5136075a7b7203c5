#pragma once

#include "scene/gltf/document/json_value.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// A textureInfo of a material: the texture registered in `textures` as color (sRGB) or data, its
/// texCoord set and its transform.
/// @throws ImportError
shared::TextureSlot read_texture_slot(const JsonValue& json, bool srgb, TextureTable& textures,
                                      Warnings& warnings);

}  // namespace heliograph::scene
