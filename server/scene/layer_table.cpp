#include "scene/layer_table.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::scene {
namespace {

// The least part of a see-through surface that is drawn: what it mirrors must fit in.
constexpr float least_coverage = 0.08f;

bool same(const shared::MaterialLayer& a, const shared::MaterialLayer& b) {
  return a.facing == b.facing && a.grazing == b.grazing && a.diffuse == b.diffuse &&
         a.coat == b.coat && a.coat_roughness == b.coat_roughness;
}

/// Reflectance of a boundary toward air, head on. An index of 0 mirrors everything (the extension's
/// way to say specular-glossiness).
float reflectance_of(float ior) {
  const float ratio = (ior - 1.0f) / (ior + 1.0f);
  return ior == 0.0f ? 1.0f : ratio * ratio;
}

float luminance(const glm::vec3& color) {
  return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// The share of light that comes through, by its mean over colours.
float passing(const shared::Material& material, const MaterialLayers& from) {
  glm::vec3 tint(material.base_color);
  if (from.thickness > 0.0f && from.attenuation_distance > 0.0f) {
    tint *= glm::pow(from.attenuation_color,
                     glm::vec3(from.thickness / from.attenuation_distance));
  }
  return from.transmission * (1.0f - material.metallic) * luminance(tint);
}

shared::MaterialLayer layer_of(const shared::Material& material, const MaterialLayers& from) {
  shared::MaterialLayer layer = plain_layer();
  // Exactly the usual 0.04 for the usual index.
  const float dielectric = material.ior == 1.5f ? layer.facing.x : reflectance_of(material.ior);
  layer.facing = glm::min(dielectric * from.specular_color, glm::vec3(1.0f)) * from.specular;
  layer.grazing = from.specular;
  layer.coat = from.clearcoat;
  layer.coat_roughness = from.clearcoat > 0.0f ? from.clearcoat_roughness : 0.0f;
  return layer;
}

/// Draws only a part of the surface, which mirrors as much as the whole and has the diffuse light
/// that is left.
void let_light_through(shared::Material& material, const MaterialLayers& from,
                       shared::MaterialLayer& layer) {
  const float coverage = std::max(1.0f - passing(material, from), least_coverage);
  layer.facing = glm::min(layer.facing / coverage, glm::vec3(1.0f));
  layer.grazing = std::max(layer.grazing, std::max({layer.facing.x, layer.facing.y, layer.facing.z}));
  layer.diffuse = std::min((1.0f - from.transmission) / coverage, 1.0f);
  if (!(material.flags & (shared::material_alpha_blend | shared::material_alpha_mask))) {
    material.base_color.w = 1.0f;
  }
  if (material.flags & shared::material_alpha_mask) return;
  material.base_color.w *= coverage;
  material.flags |= shared::material_alpha_blend;
}

}  // namespace

shared::MaterialLayer plain_layer() {
  shared::MaterialLayer layer{};
  layer.facing = glm::vec3(0.04f);
  layer.grazing = 1.0f;
  layer.diffuse = 1.0f;
  return layer;
}

void build_layers(Scene& scene, Warnings& warnings) {
  scene.layers = {plain_layer()};
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    shared::Material& material = scene.materials[i];
    if (material.flags & shared::material_unlit) continue;
    const MaterialLayers& from = scene.material_layers[i];
    shared::MaterialLayer layer = layer_of(material, from);
    if (from.transmission > 0.0f) let_light_through(material, from, layer);
    auto found = std::ranges::find_if(
        scene.layers, [&](const shared::MaterialLayer& known) { return same(known, layer); });
    if (found == scene.layers.end()) {
      if (scene.layers.size() == shared::most_layers) {
        warnings.add("more than " + std::to_string(shared::most_layers - 1) +
                     " kinds of layers: further materials are shown without theirs");
        continue;
      }
      found = scene.layers.insert(scene.layers.end(), layer);
    }
    material.layer = static_cast<std::uint32_t>(found - scene.layers.begin());
    material.coat_roughness = layer.coat_roughness;
    if (layer.coat > 0.0f) material.flags |= shared::material_coated;
  }
}

}  // namespace heliograph::scene
