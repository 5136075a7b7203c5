#pragma once

#include "scene/gltf/document/json_value.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Reads a material's extensions: specular, clearcoat, sheen, transmission and volume. Registers
/// their textures in `textures` and adds a warning for every approximation.
/// @throws ImportError
MaterialLayers read_material_layers(const JsonValue& extensions, TextureTable& textures,
                                    Warnings& warnings);

}  // namespace heliograph::scene
