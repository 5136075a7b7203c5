#pragma once

#include "scene/gltf/document/json_value.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Reads what a material's `extensions` say beyond metallic and roughness: specular, clearcoat,
/// sheen, transmission and volume. The textures they use are registered in `textures`; what the
/// picture does not show of it is said in `warnings`.
/// @throws ImportError
MaterialLayers read_material_layers(const JsonValue& extensions, TextureTable& textures,
                                    Warnings& warnings);

}  // namespace heliograph::scene
