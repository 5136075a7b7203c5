#pragma once

#include <cstddef>

#include "scene/json_value.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Reads what a material's `extensions` say beyond metallic and roughness: specular, clearcoat,
/// sheen, transmission and volume. `textures` is the number of textures in the document. What the
/// picture does not show of it is said in `warnings`.
/// @throws ImportError
MaterialLayers read_material_layers(const JsonValue& extensions, std::size_t textures,
                                    Warnings& warnings);

}  // namespace heliograph::scene
