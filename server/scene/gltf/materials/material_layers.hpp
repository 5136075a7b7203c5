#pragma once

#include <tiny_gltf.h>

#include <string>

#include "scene/gltf/materials/textures.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Reads the extensions that add layers to a material. Registers their textures in `textures`,
/// which may add warnings. `path` names the material.
MaterialLayers read_material_layers(const tinygltf::ExtensionMap& extensions,
                                    const std::string& path, TextureTable& textures,
                                    Warnings& warnings);

}  // namespace heliograph::scene
