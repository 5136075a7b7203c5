#include "scene/material_layers.hpp"

#include <cmath>
#include <initializer_list>

namespace heliograph::scene {
namespace {

class LayerReader {
 public:
  LayerReader(const JsonValue& extensions, std::size_t textures, Warnings& warnings)
      : extensions_(extensions), textures_(textures), warnings_(warnings) {}

  MaterialLayers read() {
    MaterialLayers layers;
    if (const auto json = extensions_.object("KHR_materials_specular")) {
      layers.specular = unit(*json, "specularFactor", 1.0f);
      layers.specular_color = color(*json, "specularColorFactor", glm::vec3(1.0f), no_limit);
      check_textures(*json, {"specularTexture", "specularColorTexture"});
    }
    if (const auto json = extensions_.object("KHR_materials_clearcoat")) {
      layers.clearcoat = unit(*json, "clearcoatFactor", 0.0f);
      layers.clearcoat_roughness = unit(*json, "clearcoatRoughnessFactor", 0.0f);
      check_textures(*json,
                     {"clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"});
    }
    if (const auto json = open("KHR_materials_sheen", "the sheen is left out")) {
      layers.sheen_color = color(*json, "sheenColorFactor", glm::vec3(0.0f), 1.0f);
      layers.sheen_roughness = unit(*json, "sheenRoughnessFactor", 0.0f);
      check_textures(*json, {"sheenColorTexture", "sheenRoughnessTexture"});
    }
    if (const auto json = open("KHR_materials_transmission", "light passes straight on, dimmed by the colour's luminance")) {
      layers.transmission = unit(*json, "transmissionFactor", 0.0f);
      check_textures(*json, {"transmissionTexture"});
    }
    if (const auto json = open("KHR_materials_volume", "walls are thin and refract nothing")) {
      layers.thickness = at_least_zero(*json, "thicknessFactor", 0.0f);
      layers.attenuation_distance = at_least_zero(*json, "attenuationDistance", 0.0f);
      if (json->has("attenuationDistance") && layers.attenuation_distance == 0.0f) {
        json->refuse("attenuationDistance", "must be more than 0");
      }
      layers.attenuation_color = color(*json, "attenuationColor", glm::vec3(1.0f), 1.0f);
      check_textures(*json, {"thicknessTexture"});
    }
    return layers;
  }

 private:
  static constexpr float no_limit = 3e38f;

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

  void check_textures(const JsonValue& json, std::initializer_list<std::string_view> slots) {
    for (const std::string_view slot : slots) {
      const auto texture = json.object(slot);
      if (!texture) continue;
      texture->required_index("index", textures_, "textures");
      texture->integer("texCoord");
      warnings_.add(json.path() + "." + std::string(slot) + " is left out; its factor counts");
    }
  }

  const JsonValue& extensions_;
  std::size_t textures_;
  Warnings& warnings_;
};

}  // namespace

MaterialLayers read_material_layers(const JsonValue& extensions, std::size_t textures,
                                    Warnings& warnings) {
  return LayerReader(extensions, textures, warnings).read();
}

}  // namespace heliograph::scene
