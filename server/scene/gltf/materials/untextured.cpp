#include "scene/gltf/materials/untextured.hpp"

#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"

namespace heliograph::scene {
namespace {

bool is_textured(const shared::TextureSlot& slot) {
  return slot.texture != shared::no_texture;
}

void drop_textures(shared::Material& material, MaterialLayers& layers) {
  if (is_textured(material.emissive_texture)) material.emissive = glm::vec3(0.0f);
  if (is_textured(material.metallic_roughness_texture)) material.metallic = 0.0f;
  if (is_textured(layers.transmission_texture)) {
    layers.transmission = 0.0f;
    material.passing = 0.0f;
  }
  if (is_textured(layers.diffuse_transmission_texture)) layers.diffuse_transmission = 0.0f;
  for (const TextureKind& kind : texture_kinds()) kind.of(material, layers) = no_texture_slot();
}

}  // namespace

Scene without_textures(const Scene& scene) {
  Scene made = scene;
  made.images.clear();
  made.textures.clear();
  made.replaced_textures.clear();
  for (std::size_t i = 0; i < made.materials.size(); ++i) {
    drop_textures(made.materials[i], made.material_layers[i]);
  }
  build_layers(made);
  return made;
}

}  // namespace heliograph::scene
