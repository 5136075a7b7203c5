#include "scene/gltf/materials/material_layers.hpp"

#include "scene/gltf/materials/texture_slot.hpp"

namespace heliograph::scene {
namespace {

class LayerReader {
 public:
  LayerReader(const JsonValue& extensions, TextureTable& textures, Warnings& warnings)
      : extensions_(extensions), textures_(textures), warnings_(warnings) {}

  MaterialLayers read() {
    MaterialLayers layers;
    read_specular(layers);
    read_clearcoat(layers);
    read_sheen(layers);
    read_transmission(layers);
    read_volume(layers);
    return layers;
  }

 private:
  static constexpr float no_limit = 3e38f;

  void read_specular(MaterialLayers& layers) {
    const auto json = extensions_.object("KHR_materials_specular");
    if (!json) return;
    layers.specular = unit(*json, "specularFactor", 1.0f);
    layers.specular_color = color(*json, "specularColorFactor", glm::vec3(1.0f), no_limit);
    layers.specular_texture = texture(*json, "specularTexture");
    layers.specular_color_texture = texture(*json, "specularColorTexture", true);
  }

  void read_clearcoat(MaterialLayers& layers) {
    const auto json = extensions_.object("KHR_materials_clearcoat");
    if (!json) return;
    layers.clearcoat = unit(*json, "clearcoatFactor", 0.0f);
    layers.clearcoat_roughness = unit(*json, "clearcoatRoughnessFactor", 0.0f);
    layers.clearcoat_texture = texture(*json, "clearcoatTexture");
    layers.clearcoat_roughness_texture = texture(*json, "clearcoatRoughnessTexture");
    layers.clearcoat_normal_texture = texture(*json, "clearcoatNormalTexture");
    if (const auto normal = json->object("clearcoatNormalTexture")) {
      layers.clearcoat_normal_scale = normal->number("scale", 1.0f);
    }
  }

  void read_sheen(MaterialLayers& layers) {
    const auto json = extensions_.object("KHR_materials_sheen");
    if (!json) return;
    layers.sheen_color = color(*json, "sheenColorFactor", glm::vec3(0.0f), 1.0f);
    layers.sheen_roughness = unit(*json, "sheenRoughnessFactor", 0.0f);
    layers.sheen_color_texture = texture(*json, "sheenColorTexture", true);
    layers.sheen_roughness_texture = texture(*json, "sheenRoughnessTexture");
  }

  void read_transmission(MaterialLayers& layers) {
    const auto json =
        open("KHR_materials_transmission", "transmitted light is neither refracted nor blurred");
    if (!json) return;
    layers.transmission = unit(*json, "transmissionFactor", 0.0f);
    layers.transmission_texture = texture(*json, "transmissionTexture");
  }

  void read_volume(MaterialLayers& layers) {
    const auto json = open("KHR_materials_volume", "thin walled, without refraction");
    if (!json) return;
    layers.thickness = at_least_zero(*json, "thicknessFactor", 0.0f);
    layers.attenuation_distance = at_least_zero(*json, "attenuationDistance", 0.0f);
    if (json->has("attenuationDistance") && layers.attenuation_distance == 0.0f) {
      json->refuse("attenuationDistance", "must be more than 0");
    }
    layers.attenuation_color = color(*json, "attenuationColor", glm::vec3(1.0f), 1.0f);
    layers.thickness_texture = texture(*json, "thicknessTexture");
  }

  std::optional<JsonValue> open(std::string_view name, std::string_view effect) {
    auto found = extensions_.object(name);
    if (found) {
      warnings_.add("extension \"" + std::string(name) +
                    "\" is approximated: " + std::string(effect));
    }
    return found;
  }

  float at_least_zero(const JsonValue& json, std::string_view key, float fallback) {
    const float value = json.number(key, fallback);
    if (value < 0.0f) json.refuse(key, "must not be negative");
    return value;
  }

  float unit(const JsonValue& json, std::string_view key, float fallback) {
    const float value = at_least_zero(json, key, fallback);
    if (value > 1.0f) json.refuse(key, "must be from 0 to 1");
    return value;
  }

  glm::vec3 color(const JsonValue& json, std::string_view key, const glm::vec3& fallback,
                  float limit) {
    const auto values = json.numbers<3>(key, {fallback.x, fallback.y, fallback.z});
    for (const float value : values) {
      if (value < 0.0f) json.refuse(key, "must not be negative");
      if (value > limit) json.refuse(key, "must be from 0 to 1");
    }
    return {values[0], values[1], values[2]};
  }

  shared::TextureSlot texture(const JsonValue& json, std::string_view key, bool srgb = false) {
    const auto slot = json.object(key);
    return slot ? read_texture_slot(*slot, srgb, textures_, warnings_) : no_texture_slot();
  }

  const JsonValue& extensions_;
  TextureTable& textures_;
  Warnings& warnings_;
};

}  // namespace

MaterialLayers read_material_layers(const JsonValue& extensions, TextureTable& textures,
                                    Warnings& warnings) {
  return LayerReader(extensions, textures, warnings).read();
}

}  // namespace heliograph::scene
