#pragma once

#include <tiny_gltf.h>

#include <string>

#include "scene/gltf/materials/textures.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Reads a material's extensions: specular, clearcoat, sheen, transmission and volume. Registers
/// their textures in `textures` and adds a warning for every approximation. `path` names the
/// material.
MaterialLayers read_material_layers(const tinygltf::ExtensionMap& extensions,
                                    const std::string& path, TextureTable& textures,
                                    Warnings& warnings);

}  // namespace heliograph::scene
