#include "scene/gltf/materials/materials.hpp"

#include <cmath>
#include <map>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/materials/material_layers.hpp"
#include "scene/gltf/materials/texture_slot.hpp"

namespace heliograph::scene {
namespace {

class MaterialReader {
 public:
  MaterialReader(TextureTable& textures, Warnings& warnings)
      : textures_(textures), warnings_(warnings) {}

  shared::Material read(const tinygltf::Material& document, const std::string& path) {
    shared::Material material = default_material();
    read_metallic_roughness(document.pbrMetallicRoughness, path + ".pbrMetallicRoughness",
                            material);
    material.normal_texture = read_slot(document.normalTexture, path + ".normalTexture", false);
    material.normal_scale = static_cast<float>(document.normalTexture.scale);
    material.occlusion_texture =
        read_slot(document.occlusionTexture, path + ".occlusionTexture", false);
    material.occlusion_strength = static_cast<float>(document.occlusionTexture.strength);
    material.emissive_texture =
        read_slot(document.emissiveTexture, path + ".emissiveTexture", true);
    for (int i = 0; i < 3; ++i) {
      material.emissive[i] = static_cast<float>(document.emissiveFactor[i]);
    }
    if (document.alphaMode == "MASK") material.flags |= shared::material_alpha_mask;
    if (document.alphaMode == "BLEND") material.flags |= shared::material_alpha_blend;
    material.alpha_cutoff = static_cast<float>(document.alphaCutoff);
    if (document.doubleSided) material.flags |= shared::material_double_sided;
    read_extensions(document.extensions, path, material);
    return material;
  }

 private:
  void read_metallic_roughness(const tinygltf::PbrMetallicRoughness& pbr, const std::string& path,
                               shared::Material& material) {
    for (int i = 0; i < 4; ++i) {
      material.base_color[i] = static_cast<float>(pbr.baseColorFactor[i]);
    }
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.base_color_texture = read_slot(pbr.baseColorTexture, path + ".baseColorTexture", true);
    material.metallic_roughness_texture =
        read_slot(pbr.metallicRoughnessTexture, path + ".metallicRoughnessTexture", false);
  }

  void read_extensions(const tinygltf::ExtensionMap& extensions, const std::string& path,
                       shared::Material& material) {
    if (const auto strength = find_extension(extensions, "KHR_materials_emissive_strength", path)) {
      material.emissive *= strength->number("emissiveStrength", 1.0f);
      if (!std::isfinite(material.emissive.x + material.emissive.y + material.emissive.z)) {
        strength->refuse("emissiveStrength", "makes the emission overflow");
      }
    }
    if (const auto ior = find_extension(extensions, "KHR_materials_ior", path)) {
      material.ior = ior->number("ior", 1.5f);
      if (material.ior != 0.0f && material.ior < 1.0f) {
        ior->refuse("ior", "must be 0, or 1 and more");
      }
    }
    if (const auto other =
            find_extension(extensions, "KHR_materials_pbrSpecularGlossiness", path)) {
      read_specular_glossiness(*other, material);
    }
    if (extensions.contains("KHR_materials_unlit")) material.flags |= shared::material_unlit;
  }

  /// Replaces the core material, which files have as an approximation for others.
  void read_specular_glossiness(const ExtensionValue& value, shared::Material& material) {
    const auto diffuse = value.numbers<4>("diffuseFactor", {1.0f, 1.0f, 1.0f, 1.0f});
    const auto specular = value.numbers<3>("specularFactor", {1.0f, 1.0f, 1.0f});
    const SpecularGlossiness factors = {.diffuse = {diffuse[0], diffuse[1], diffuse[2], diffuse[3]},
                                        .specular = {specular[0], specular[1], specular[2]},
                                        .glossiness = value.number("glossinessFactor", 1.0f)};
    const auto diffuse_info = value.object("diffuseTexture");
    const auto specular_info = value.object("specularGlossinessTexture");
    const auto texture_of = [](const std::optional<ExtensionValue>& info) {
      return info ? info->index("index") : std::nullopt;
    };
    const auto convert = [&](ConvertedImage kind) {
      if (!diffuse_info && !specular_info) return no_texture_slot();
      shared::TextureSlot slot = read_uv(diffuse_info ? *diffuse_info : *specular_info, warnings_);
      slot.texture = textures_.use_converted(kind, factors, texture_of(diffuse_info),
                                             texture_of(specular_info));
      return slot;
    };
    material.base_color_texture = convert(ConvertedImage::base_color);
    material.metallic_roughness_texture = convert(ConvertedImage::metallic_roughness);
    const bool in_texels = material.base_color_texture.texture != shared::no_texture;
    const MetallicRoughness plain = to_metallic_roughness(factors);
    material.base_color = in_texels ? glm::vec4(1.0f) : plain.base_color;
    material.metallic = in_texels ? 1.0f : plain.metallic;
    material.roughness = in_texels ? 1.0f : plain.roughness;
  }

  template <typename TextureInfo>
  shared::TextureSlot read_slot(const TextureInfo& info, const std::string& path, bool srgb) {
    return read_texture_slot(info, path, srgb, textures_, warnings_);
  }

  TextureTable& textures_;
  Warnings& warnings_;
};

std::uint32_t append_alpha(const Image& image, std::vector<std::uint8_t>& heap) {
  const auto offset = static_cast<std::uint32_t>(heap.size());
  const std::size_t count = std::size_t(image.width) * image.height;
  heap.reserve(heap.size() + count);
  for (std::size_t i = 0; i < count; ++i) heap.push_back(image.pixels[4 * i + 3]);
  return offset;
}

}  // namespace

shared::Material default_material() {
  shared::Material material{};
  material.base_color = glm::vec4(1.0f);
  material.alpha_cutoff = 0.5f;
  material.metallic = 1.0f;
  material.roughness = 1.0f;
  material.normal_scale = 1.0f;
  material.occlusion_strength = 1.0f;
  material.ior = 1.5f;
  material.alpha_mask = shared::no_texture;
  material.base_color_texture = no_texture_slot();
  material.metallic_roughness_texture = no_texture_slot();
  material.normal_texture = no_texture_slot();
  material.occlusion_texture = no_texture_slot();
  material.emissive_texture = no_texture_slot();
  return material;
}

MaterialTable read_materials(const tinygltf::Model& model, TextureTable& textures,
                             Warnings& warnings) {
  MaterialTable table;
  MaterialReader reader(textures, warnings);
  for (const tinygltf::Material& document : model.materials) {
    const std::string path = item_path("", "materials", table.materials.size());
    table.materials.push_back(reader.read(document, path));
    table.layers.push_back(read_material_layers(document.extensions, path, textures, warnings));
    const auto& factor = document.emissiveFactor;
    table.layers.back().emissive_factor = glm::vec3(factor[0], factor[1], factor[2]);
    table.names.push_back(document.name);
  }
  return table;
}

void drop_missing_images(Scene& scene, const std::vector<std::string>& problems,
                         Warnings& warnings) {
  for (const std::string& problem : problems) {
    if (!problem.empty()) warnings.add(problem + ": materials are shown without it");
  }
  const auto drop = [&](shared::TextureSlot& slot) {
    if (slot.texture == shared::no_texture) return;
    if (!problems[scene.textures[slot.texture].image].empty()) slot = no_texture_slot();
  };
  for (shared::Material& material : scene.materials) drop(material.normal_texture);
  for (MaterialLayers& layers : scene.material_layers) {
    drop(layers.clearcoat_normal_texture);
    drop(layers.anisotropy_texture);
  }
}

void build_alpha_heap(Scene& scene) {
  std::map<std::uint32_t, std::uint32_t> offset_of_image;
  for (shared::Material& material : scene.materials) {
    const std::uint32_t index = material.base_color_texture.texture;
    const std::uint32_t partial = shared::material_alpha_mask | shared::material_alpha_blend;
    const bool whole = (material.flags & shared::material_whole_alpha) != 0;
    if (!(material.flags & partial) || whole || index == shared::no_texture) continue;
    const Texture& texture = scene.textures[index];
    const Image& image = scene.images[texture.image];
    const auto known = offset_of_image.find(texture.image);
    material.alpha_mask =
        known != offset_of_image.end() ? known->second : append_alpha(image, scene.alpha_heap);
    offset_of_image[texture.image] = material.alpha_mask;
    material.alpha_mask_size = image.width | image.height << 16;
    material.alpha_mask_wrap = texture.sampler.wrap_s | texture.sampler.wrap_t << 8;
  }
}

}  // namespace heliograph::scene
