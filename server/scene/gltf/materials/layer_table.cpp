#include "scene/gltf/materials/layer_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace heliograph::scene {
namespace {

// Minimum opacity of a transmissive surface, so that its reflection fits in.
constexpr float least_coverage = 0.08f;

bool same(const shared::MaterialLayer& a, const shared::MaterialLayer& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Reflectance at normal incidence of a boundary to air. An ior of 0 reflects everything
/// (KHR_materials_ior for specular-glossiness).
float reflectance_of(float ior) {
  const float ratio = (ior - 1.0f) / (ior + 1.0f);
  return ior == 0.0f ? 1.0f : ratio * ratio;
}

float luminance(const glm::vec3& color) {
  return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Linear mean of a slot's texels, from the smallest mip level. White without a texture.
glm::vec3 mean_texel(const Scene& scene, const shared::TextureSlot& slot) {
  if (slot.texture == shared::no_texture) return glm::vec3(1.0f);
  const Image& image = scene.images[scene.textures[slot.texture].image];
  const std::size_t width = std::max(image.width >> (image.levels - 1), 1u);
  const std::size_t count = width * std::max(image.height >> (image.levels - 1), 1u);
  glm::vec3 sum(0.0f);
  for (std::size_t i = image.pixels.size() - 4 * count; i < image.pixels.size(); i += 4) {
    const glm::vec3 texel = glm::vec3(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]);
    sum += image.srgb ? glm::pow(texel / 255.0f, glm::vec3(2.2f)) : texel / 255.0f;
  }
  return sum / static_cast<float>(count);
}

/// Exponents per metre (KHR_materials_volume). Thin walls attenuate nothing.
glm::vec3 attenuation(const MaterialLayers& from) {
  if (from.thickness <= 0.0f || from.attenuation_distance <= 0.0f) return glm::vec3(0.0f);
  const glm::vec3 color = glm::max(from.attenuation_color, glm::vec3(1e-6f));
  return -glm::log(color) / from.attenuation_distance;
}

/// After the whole thickness, in mesh space.
glm::vec3 absorption(const MaterialLayers& from) {
  return attenuation(from) * from.thickness;
}

/// Per material, the mean length_scale() of its instances, in the default pose; 1 without any.
std::vector<float> mean_scales(const Scene& scene) {
  std::vector<double> sums(scene.materials.size());
  std::vector<std::uint32_t> counts(scene.materials.size());
  for (const Instance& instance : scene.instances) {
    const std::uint32_t material = scene.meshes[instance.mesh].material;
    sums[material] += length_scale(scene.nodes[instance.node].world);
    ++counts[material];
  }
  std::vector<float> means;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    means.push_back(counts[i] > 0 ? static_cast<float>(sums[i] / counts[i]) : 1.0f);
  }
  return means;
}

/// Transmitted fraction of light, averaged over colors and texels. `scale`: of the thickness.
float passing(const Scene& scene, const shared::Material& material, const MaterialLayers& from,
              float scale) {
  const float thickness = scale * mean_texel(scene, from.thickness_texture).y;
  const glm::vec3 tint = glm::vec3(material.base_color) *
                         mean_texel(scene, material.base_color_texture) *
                         glm::exp(-absorption(from) * thickness);
  const float metallic =
      material.metallic * mean_texel(scene, material.metallic_roughness_texture).z;
  return from.transmission * mean_texel(scene, from.transmission_texture).x * (1.0f - metallic) *
         luminance(tint);
}

/// Treats a transmissive surface as a blended one, with the transmitted fraction as transparency.
void let_light_through(const Scene& scene, shared::Material& material, const MaterialLayers& from,
                       float scale) {
  if (!(material.flags & shared::material_alpha_blend)) {
    material.base_color.w = 1.0f;
    material.flags |= shared::material_alpha_blend | shared::material_whole_alpha;
  }
  material.passing = std::min(passing(scene, material, from, scale), 1.0f - least_coverage);
}

}  // namespace

shared::MaterialLayer plain_layer() {
  shared::MaterialLayer layer{};
  layer.specular_color = glm::vec3(1.0f);
  layer.specular = 1.0f;
  layer.dielectric = 0.04f;
  layer.coat_normal_scale = 1.0f;
  layer.film_ior = 1.0f;
  layer.grain_x = 1.0f;
  layer.diffuse_tint = glm::vec3(1.0f);
  for (shared::TextureSlot* slot :
       {&layer.specular_texture, &layer.specular_color_texture, &layer.coat_texture,
        &layer.coat_roughness_texture, &layer.coat_normal_texture, &layer.sheen_color_texture,
        &layer.sheen_roughness_texture, &layer.transmission_texture, &layer.thickness_texture,
        &layer.iridescence_texture, &layer.film_texture, &layer.anisotropy_texture,
        &layer.diffuse_transmission_texture, &layer.diffuse_tint_texture}) {
    *slot = no_texture_slot();
  }
  return layer;
}

bool adds_nothing(const shared::MaterialLayer& layer) {
  return same(layer, plain_layer());
}

bool scatters_through(std::span<const shared::MaterialLayer> layers) {
  return std::ranges::any_of(
      layers, [](const shared::MaterialLayer& layer) { return layer.diffuse_transmission > 0.0f; });
}

bool disperses(std::span<const shared::MaterialLayer> layers) {
  return std::ranges::any_of(
      layers, [](const shared::MaterialLayer& layer) { return layer.dispersion > 0.0f; });
}

shared::MaterialLayer layer_of(const shared::Material& material, const MaterialLayers& from) {
  shared::MaterialLayer layer = plain_layer();
  // Exactly 0.04 for the default ior of 1.5.
  if (material.ior != 1.5f) layer.dielectric = reflectance_of(material.ior);
  layer.specular = from.specular;
  layer.specular_color = from.specular_color;
  layer.specular_texture = from.specular_texture;
  layer.specular_color_texture = from.specular_color_texture;
  if (from.clearcoat > 0.0f) {
    layer.coat = from.clearcoat;
    layer.coat_roughness = from.clearcoat_roughness;
    layer.coat_normal_scale = from.clearcoat_normal_scale;
    layer.coat_texture = from.clearcoat_texture;
    layer.coat_roughness_texture = from.clearcoat_roughness_texture;
    layer.coat_normal_texture = from.clearcoat_normal_texture;
  }
  if (from.sheen_color != glm::vec3(0.0f)) {
    layer.sheen = from.sheen_color;
    layer.sheen_roughness = from.sheen_roughness;
    layer.sheen_color_texture = from.sheen_color_texture;
    layer.sheen_roughness_texture = from.sheen_roughness_texture;
  }
  if (from.transmission > 0.0f && !(material.flags & shared::material_alpha_mask)) {
    layer.transmission = from.transmission;
    layer.absorption = absorption(from);
    layer.transmission_texture = from.transmission_texture;
    layer.thickness_texture = from.thickness_texture;
    layer.attenuation = attenuation(from);
    // An ior of 0 lets nothing in.
    if (from.thickness > 0.0f) layer.refraction = std::max(material.ior, 1.0f);
    layer.dispersion = from.dispersion;
  }
  if (from.iridescence > 0.0f) {
    layer.iridescence = from.iridescence;
    layer.film_ior = from.iridescence_ior;
    // Without a texture the film is as thick as the maximum everywhere: its texel is 1.
    layer.film_least = from.iridescence_thickness_minimum;
    layer.film_thickness = from.iridescence_thickness_maximum;
    layer.iridescence_texture = from.iridescence_texture;
    layer.film_texture = from.iridescence_thickness_texture;
  }
  if (from.anisotropy > 0.0f) {
    layer.anisotropy = from.anisotropy;
    layer.grain_x = std::cos(from.anisotropy_rotation);
    layer.grain_y = std::sin(from.anisotropy_rotation);
    layer.anisotropy_texture = from.anisotropy_texture;
  }
  if (from.diffuse_transmission > 0.0f) {
    layer.diffuse_transmission = from.diffuse_transmission;
    layer.diffuse_tint = from.diffuse_transmission_color;
    layer.diffuse_transmission_texture = from.diffuse_transmission_texture;
    layer.diffuse_tint_texture = from.diffuse_transmission_color_texture;
    // A wall, however thick: what it lets through is what the whole thickness leaves.
    layer.absorption = absorption(from);
    layer.thickness_texture = from.thickness_texture;
  }
  return layer;
}

void build_layers(Scene& scene) {
  scene.layers = {plain_layer()};
  const std::vector<float> scales = mean_scales(scene);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    shared::Material& material = scene.materials[i];
    if (material.flags & shared::material_unlit) continue;
    const MaterialLayers& from = scene.material_layers[i];
    const shared::MaterialLayer layer = layer_of(material, from);
    if (layer.transmission > 0.0f) let_light_through(scene, material, from, scales[i]);
    auto found = std::ranges::find_if(
        scene.layers, [&](const shared::MaterialLayer& known) { return same(known, layer); });
    if (found == scene.layers.end()) found = scene.layers.insert(scene.layers.end(), layer);
    material.layer = static_cast<std::uint32_t>(found - scene.layers.begin());
  }
}

}  // namespace heliograph::scene
