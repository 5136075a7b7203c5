#include "scene/gltf/materials/texture_kinds.hpp"

#include <algorithm>

namespace heliograph::scene {
namespace {

using Base = shared::Material;
using Layers = MaterialLayers;

constexpr const char* base_owner = "pbrMetallicRoughness";
constexpr const char* specular_owner = "KHR_materials_specular";
constexpr const char* coat_owner = "KHR_materials_clearcoat";
constexpr const char* sheen_owner = "KHR_materials_sheen";
constexpr const char* iridescence_owner = "KHR_materials_iridescence";
constexpr const char* diffuse_owner = "KHR_materials_diffuse_transmission";

constexpr TextureKind base_kind(std::string_view name, bool srgb, const char* owner,
                                const char* member, shared::TextureSlot Base::*slot) {
  return {name, srgb, owner, member, slot, nullptr};
}

constexpr TextureKind layer_kind(std::string_view name, bool srgb, const char* owner,
                                 const char* member, shared::TextureSlot Layers::*slot) {
  return {name, srgb, owner, member, nullptr, slot};
}

constexpr TextureKind known_kinds[] = {
    base_kind("base_color", true, base_owner, "baseColorTexture", &Base::base_color_texture),
    base_kind("metallic_roughness", false, base_owner, "metallicRoughnessTexture",
              &Base::metallic_roughness_texture),
    base_kind("normal", false, "", "normalTexture", &Base::normal_texture),
    base_kind("occlusion", false, "", "occlusionTexture", &Base::occlusion_texture),
    base_kind("emissive", true, "", "emissiveTexture", &Base::emissive_texture),
    layer_kind("specular", false, specular_owner, "specularTexture", &Layers::specular_texture),
    layer_kind("specular_color", true, specular_owner, "specularColorTexture",
               &Layers::specular_color_texture),
    layer_kind("clearcoat", false, coat_owner, "clearcoatTexture", &Layers::clearcoat_texture),
    layer_kind("clearcoat_roughness", false, coat_owner, "clearcoatRoughnessTexture",
               &Layers::clearcoat_roughness_texture),
    layer_kind("clearcoat_normal", false, coat_owner, "clearcoatNormalTexture",
               &Layers::clearcoat_normal_texture),
    layer_kind("sheen_color", true, sheen_owner, "sheenColorTexture", &Layers::sheen_color_texture),
    layer_kind("sheen_roughness", false, sheen_owner, "sheenRoughnessTexture",
               &Layers::sheen_roughness_texture),
    layer_kind("transmission", false, "KHR_materials_transmission", "transmissionTexture",
               &Layers::transmission_texture),
    layer_kind("thickness", false, "KHR_materials_volume", "thicknessTexture",
               &Layers::thickness_texture),
    layer_kind("iridescence", false, iridescence_owner, "iridescenceTexture",
               &Layers::iridescence_texture),
    layer_kind("iridescence_thickness", false, iridescence_owner, "iridescenceThicknessTexture",
               &Layers::iridescence_thickness_texture),
    layer_kind("anisotropy", false, "KHR_materials_anisotropy", "anisotropyTexture",
               &Layers::anisotropy_texture),
    layer_kind("diffuse_transmission", false, diffuse_owner, "diffuseTransmissionTexture",
               &Layers::diffuse_transmission_texture),
    layer_kind("diffuse_transmission_color", true, diffuse_owner, "diffuseTransmissionColorTexture",
               &Layers::diffuse_transmission_color_texture),
};

}  // namespace

std::span<const TextureKind> texture_kinds() {
  return known_kinds;
}

const TextureKind* find_texture_kind(std::string_view name) {
  const auto found = std::ranges::find(known_kinds, name, &TextureKind::name);
  return found == std::ranges::end(known_kinds) ? nullptr : found;
}

}  // namespace heliograph::scene
