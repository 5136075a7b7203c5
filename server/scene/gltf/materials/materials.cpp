#include "scene/gltf/materials/materials.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/gltf/materials/material_layers.hpp"
#include "scene/gltf/materials/texture_slot.hpp"

namespace heliograph::scene {
namespace {

class MaterialReader {
 public:
  MaterialReader(TextureTable& textures, Warnings& warnings)
      : textures_(textures), warnings_(warnings) {}

  shared::Material read(const JsonValue& json) {
    shared::Material material = default_material();
    if (const auto pbr = json.object("pbrMetallicRoughness"))
      read_metallic_roughness(*pbr, material);
    if (const auto normal = json.object("normalTexture")) {
      material.normal_texture = read_slot(*normal, false);
      material.normal_scale = normal->number("scale", 1.0f);
    }
    if (const auto occlusion = json.object("occlusionTexture")) {
      material.occlusion_texture = read_slot(*occlusion, false);
      material.occlusion_strength = unit_number(*occlusion, "strength");
    }
    if (const auto emissive = json.object("emissiveTexture")) {
      material.emissive_texture = read_slot(*emissive, true);
    }
    read_emissive_factor(json, material);
    read_alpha(json, material);
    if (json.boolean("doubleSided", false)) material.flags |= shared::material_double_sided;
    read_extensions(json, material);
    return material;
  }

 private:
  // Factors that the specification keeps within 0..1.
  float to_unit(const JsonValue& owner, std::string_view key, float value) {
    const float clamped = std::clamp(value, 0.0f, 1.0f);
    if (clamped != value) {
      warnings_.add(owner.path() + "." + std::string(key) + " is outside 0..1 and was clamped");
    }
    return clamped;
  }

  float unit_number(const JsonValue& owner, std::string_view key) {
    return to_unit(owner, key, owner.number(key, 1.0f));
  }

  void read_metallic_roughness(const JsonValue& pbr, shared::Material& material) {
    const auto color = pbr.numbers<4>("baseColorFactor", {1.0f, 1.0f, 1.0f, 1.0f});
    for (int i = 0; i < 4; ++i) material.base_color[i] = to_unit(pbr, "baseColorFactor", color[i]);
    material.metallic = unit_number(pbr, "metallicFactor");
    material.roughness = unit_number(pbr, "roughnessFactor");
    if (const auto slot = pbr.object("baseColorTexture")) {
      material.base_color_texture = read_slot(*slot, true);
    }
    if (const auto slot = pbr.object("metallicRoughnessTexture")) {
      material.metallic_roughness_texture = read_slot(*slot, false);
    }
  }

  // Old exporters write emissive factors above one: accepted, but not negative ones.
  void read_emissive_factor(const JsonValue& json, shared::Material& material) {
    const auto factor = json.numbers<3>("emissiveFactor", {0.0f, 0.0f, 0.0f});
    for (int i = 0; i < 3; ++i) {
      if (factor[i] < 0.0f) json.refuse("emissiveFactor", "must not be negative");
      material.emissive[i] = factor[i];
    }
  }

  void read_alpha(const JsonValue& json, shared::Material& material) {
    const std::string mode = json.text("alphaMode");
    if (mode == "MASK") {
      material.flags |= shared::material_alpha_mask;
    } else if (mode == "BLEND") {
      material.flags |= shared::material_alpha_blend;
    } else if (!mode.empty() && mode != "OPAQUE") {
      json.refuse("alphaMode", "is not OPAQUE, MASK or BLEND");
    }
    material.alpha_cutoff = json.number("alphaCutoff", 0.5f);
    if (material.alpha_cutoff < 0.0f) json.refuse("alphaCutoff", "must not be negative");
  }

  void read_extensions(const JsonValue& json, shared::Material& material) {
    const auto extensions = json.object("extensions");
    if (!extensions) return;
    if (const auto strength = extensions->object("KHR_materials_emissive_strength")) {
      const float factor = strength->number("emissiveStrength", 1.0f);
      if (factor < 0.0f) strength->refuse("emissiveStrength", "must not be negative");
      material.emissive *= factor;
      if (!std::isfinite(material.emissive.x + material.emissive.y + material.emissive.z)) {
        strength->refuse("emissiveStrength", "makes the emission overflow");
      }
    }
    if (const auto ior = extensions->object("KHR_materials_ior")) {
      material.ior = ior->number("ior", 1.5f);
      if (material.ior != 0.0f && material.ior < 1.0f)
        ior->refuse("ior", "must be 0, or 1 and more");
    }
    if (extensions->has("KHR_materials_unlit")) material.flags |= shared::material_unlit;
  }

  shared::TextureSlot read_slot(const JsonValue& json, bool srgb) {
    return read_texture_slot(json, srgb, textures_, warnings_);
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

MaterialTable read_materials(const JsonValue& root, TextureTable& textures, Warnings& warnings) {
  MaterialTable table;
  MaterialReader reader(textures, warnings);
  for (const JsonValue& json : root.objects("materials")) {
    table.materials.push_back(reader.read(json));
    const auto extensions = json.object("extensions");
    table.layers.push_back(extensions ? read_material_layers(*extensions, textures, warnings)
                                      : MaterialLayers());
    table.names.push_back(json.text("name"));
  }
  return table;
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
