#include "scene/gltf/materials/material_layers.hpp"

#include "scene/gltf/materials/texture_slot.hpp"

namespace heliograph::scene {
namespace {

class LayerReader {
 public:
  LayerReader(const tinygltf::ExtensionMap& extensions, const std::string& path,
              TextureTable& textures, Warnings& warnings)
      : extensions_(extensions), path_(path), textures_(textures), warnings_(warnings) {}

  MaterialLayers read() {
    MaterialLayers layers;
    read_emissive_strength(layers);
    read_specular(layers);
    read_clearcoat(layers);
    read_sheen(layers);
    read_transmission(layers);
    read_volume(layers);
    read_dispersion(layers);
    read_iridescence(layers);
    read_anisotropy(layers);
    read_diffuse_transmission(layers);
    return layers;
  }

 private:
  void read_emissive_strength(MaterialLayers& layers) {
    const auto json = find("KHR_materials_emissive_strength");
    if (json) layers.emissive_strength = json->number("emissiveStrength", 1.0f);
  }

  void read_specular(MaterialLayers& layers) {
    const auto json = find("KHR_materials_specular");
    if (!json) return;
    layers.specular = json->number("specularFactor", 1.0f);
    layers.specular_color = color(*json, "specularColorFactor", 1.0f);
    layers.specular_texture = texture(*json, "specularTexture");
    layers.specular_color_texture = texture(*json, "specularColorTexture", true);
  }

  void read_clearcoat(MaterialLayers& layers) {
    const auto json = find("KHR_materials_clearcoat");
    if (!json) return;
    layers.clearcoat = json->number("clearcoatFactor", 0.0f);
    layers.clearcoat_roughness = json->number("clearcoatRoughnessFactor", 0.0f);
    layers.clearcoat_texture = texture(*json, "clearcoatTexture");
    layers.clearcoat_roughness_texture = texture(*json, "clearcoatRoughnessTexture");
    layers.clearcoat_normal_texture = texture(*json, "clearcoatNormalTexture");
    if (const auto normal = json->object("clearcoatNormalTexture")) {
      layers.clearcoat_normal_scale = normal->number("scale", 1.0f);
    }
  }

  void read_sheen(MaterialLayers& layers) {
    const auto json = find("KHR_materials_sheen");
    if (!json) return;
    layers.sheen_color = color(*json, "sheenColorFactor", 0.0f);
    layers.sheen_roughness = json->number("sheenRoughnessFactor", 0.0f);
    layers.sheen_color_texture = texture(*json, "sheenColorTexture", true);
    layers.sheen_roughness_texture = texture(*json, "sheenRoughnessTexture");
  }

  void read_transmission(MaterialLayers& layers) {
    const auto json = find("KHR_materials_transmission");
    if (!json) return;
    layers.transmission = json->number("transmissionFactor", 0.0f);
    layers.transmission_texture = texture(*json, "transmissionTexture");
  }

  void read_volume(MaterialLayers& layers) {
    const auto json = find("KHR_materials_volume");
    if (!json) return;
    layers.thickness = json->number("thicknessFactor", 0.0f);
    layers.attenuation_distance = json->number("attenuationDistance", 0.0f);
    layers.attenuation_color = color(*json, "attenuationColor", 1.0f);
    layers.thickness_texture = texture(*json, "thicknessTexture");
  }

  void read_dispersion(MaterialLayers& layers) {
    const auto json = find("KHR_materials_dispersion");
    if (json) layers.dispersion = json->number("dispersion", 0.0f);
  }

  void read_iridescence(MaterialLayers& layers) {
    const auto json = find("KHR_materials_iridescence");
    if (!json) return;
    layers.iridescence = json->number("iridescenceFactor", 0.0f);
    layers.iridescence_ior = json->number("iridescenceIor", 1.3f);
    layers.iridescence_thickness_minimum = json->number("iridescenceThicknessMinimum", 100.0f);
    layers.iridescence_thickness_maximum = json->number("iridescenceThicknessMaximum", 400.0f);
    layers.iridescence_texture = texture(*json, "iridescenceTexture");
    layers.iridescence_thickness_texture = texture(*json, "iridescenceThicknessTexture");
  }

  void read_anisotropy(MaterialLayers& layers) {
    const auto json = find("KHR_materials_anisotropy");
    if (!json) return;
    layers.anisotropy = json->number("anisotropyStrength", 0.0f);
    layers.anisotropy_rotation = json->number("anisotropyRotation", 0.0f);
    layers.anisotropy_texture = texture(*json, "anisotropyTexture");
  }

  void read_diffuse_transmission(MaterialLayers& layers) {
    const auto json = find("KHR_materials_diffuse_transmission");
    if (!json) return;
    layers.diffuse_transmission = json->number("diffuseTransmissionFactor", 0.0f);
    layers.diffuse_transmission_color = color(*json, "diffuseTransmissionColorFactor", 1.0f);
    layers.diffuse_transmission_texture = texture(*json, "diffuseTransmissionTexture");
    layers.diffuse_transmission_color_texture =
        texture(*json, "diffuseTransmissionColorTexture", true);
  }

  std::optional<ExtensionValue> find(const std::string& name) const {
    return find_extension(extensions_, name, path_);
  }

  static glm::vec3 color(const ExtensionValue& value, const std::string& member, float fallback) {
    const auto values = value.numbers<3>(member, {fallback, fallback, fallback});
    return {values[0], values[1], values[2]};
  }

  shared::TextureSlot texture(const ExtensionValue& json, const std::string& key,
                              bool srgb = false) {
    const auto slot = json.object(key);
    return slot ? read_texture_slot(*slot, srgb, textures_, warnings_) : no_texture_slot();
  }

  const tinygltf::ExtensionMap& extensions_;
  const std::string& path_;
  TextureTable& textures_;
  Warnings& warnings_;
};

}  // namespace

MaterialLayers read_material_layers(const tinygltf::ExtensionMap& extensions,
                                    const std::string& path, TextureTable& textures,
                                    Warnings& warnings) {
  return LayerReader(extensions, path, textures, warnings).read();
}

}  // namespace heliograph::scene
