#pragma once

#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

struct MaterialTable {
  std::vector<shared::Material> materials;
  std::vector<MaterialLayers> layers;
  std::vector<std::string> names;
};

/// glTF's default material: white, fully metallic, fully rough, opaque.
shared::Material default_material();

/// All materials of the document; the textures they use are registered in `textures`.
/// @throws ImportError
MaterialTable read_materials(const tinygltf::Model& model, TextureTable& textures,
                             Warnings& warnings);

/// Removes textures of directions that were not decoded: `problems` of the scene's images. The
/// others are white, which leaves the factors as they are. Adds a warning for each problem.
void drop_missing_images(Scene& scene, const std::vector<std::string>& problems,
                         Warnings& warnings);

/// Copies the level-0 alpha of masked base colors into scene.alpha_heap, for alpha tests of rays,
/// and links the materials to it. Shared images are stored once.
void build_alpha_heap(Scene& scene);

}  // namespace heliograph::scene
