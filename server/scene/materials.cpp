#include "scene/materials.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/material_layers.hpp"

namespace heliograph::scene {
namespace {

shared::TextureSlot empty_slot() {
  shared::TextureSlot slot{};
  slot.transform_row0 = {1.0f, 0.0f, 0.0f, 0.0f};
  slot.transform_row1 = {0.0f, 1.0f, 0.0f, 0.0f};
  slot.texture = shared::no_texture;
  return slot;
}

// KHR_texture_transform: translation * rotation * scale, the rotation counter-clockwise as seen
// with v pointing down. The sample matrix in the extension's text turns the other way; its test
// model and the implementations agree on this one (github.com/KhronosGroup/glTF/issues/1563).
void apply_transform(const JsonValue& transform, shared::TextureSlot& slot) {
  const auto offset = transform.numbers<2>("offset", {0.0f, 0.0f});
  const auto scale = transform.numbers<2>("scale", {1.0f, 1.0f});
  const float rotation = transform.number("rotation", 0.0f);
  const float cosine = std::cos(rotation);
  const float sine = std::sin(rotation);
  slot.transform_row0 = {cosine * scale[0], sine * scale[1], offset[0], 0.0f};
  slot.transform_row1 = {-sine * scale[0], cosine * scale[1], offset[1], 0.0f};
}

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

  // Old exporters write emissive factors above one; light may be bright, but not negative.
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
        strength->refuse("emissiveStrength", "makes the emission too large");
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
    shared::TextureSlot slot = empty_slot();
    const std::uint32_t texture = json.required_index("index", textures_.size(), "textures");
    std::uint64_t uv_set = json.integer("texCoord", 0);
    if (const auto transform = json.object("extensions", "KHR_texture_transform")) {
      apply_transform(*transform, slot);
      uv_set = transform->integer("texCoord", uv_set);
    }
    if (uv_set > 1) {
      warnings_.add(json.path() + ".texCoord: only the sets 0 and 1 are kept, 0 is used");
      uv_set = 0;
    }
    slot.uv_set = static_cast<std::uint32_t>(uv_set);
    slot.texture = textures_.use(texture, srgb);
    if (slot.texture == shared::no_texture) {
      warnings_.add("textures[" + std::to_string(texture) +
                    "] has no PNG, JPEG or WebP image and was left out");
    }
    return slot;
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
  material.base_color_texture = empty_slot();
  material.metallic_roughness_texture = empty_slot();
  material.normal_texture = empty_slot();
  material.occlusion_texture = empty_slot();
  material.emissive_texture = empty_slot();
  return material;
}

MaterialTable read_materials(const JsonValue& root, TextureTable& textures, Warnings& warnings) {
  MaterialTable table;
  MaterialReader reader(textures, warnings);
  const std::size_t texture_count = textures.size();
  for (const JsonValue& json : root.objects("materials")) {
    table.materials.push_back(reader.read(json));
    const auto extensions = json.object("extensions");
    table.layers.push_back(extensions ? read_material_layers(*extensions, texture_count, warnings)
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
    if (!(material.flags & partial) || index == shared::no_texture) continue;
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
