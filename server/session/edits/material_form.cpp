#include "session/edits/material_form.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "scene/gltf/materials/layer_table.hpp"
#include "session/edits/edited_parts.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::MaterialInfo;
using protocol::MaterialPatch;
using protocol::Result;
namespace error = protocol::error;

namespace {

/// Calls `visit` with the name of every factor that glTF's base material has, with its member of a
/// material and with that of a patch.
void visit_base_factors(const auto& visit) {
  using Info = MaterialInfo;
  using Patch = MaterialPatch;
  visit("base_color", &Info::base_color, &Patch::base_color);
  visit("roughness", &Info::roughness, &Patch::roughness);
  visit("metallic", &Info::metallic, &Patch::metallic);
  visit("emissive", &Info::emissive, &Patch::emissive);
  visit("normal_scale", &Info::normal_scale, &Patch::normal_scale);
  visit("occlusion_strength", &Info::occlusion_strength, &Patch::occlusion_strength);
}

/// The same of every factor of extensions.
void visit_extension_factors(const auto& visit) {
  using Info = MaterialInfo;
  using Patch = MaterialPatch;
  visit("ior", &Info::ior, &Patch::ior);
  visit("specular", &Info::specular, &Patch::specular);
  visit("specular_color", &Info::specular_color, &Patch::specular_color);
  visit("clearcoat", &Info::clearcoat, &Patch::clearcoat);
  visit("clearcoat_roughness", &Info::clearcoat_roughness, &Patch::clearcoat_roughness);
  visit("clearcoat_normal_scale", &Info::clearcoat_normal_scale, &Patch::clearcoat_normal_scale);
  visit("sheen_color", &Info::sheen_color, &Patch::sheen_color);
  visit("sheen_roughness", &Info::sheen_roughness, &Patch::sheen_roughness);
  visit("iridescence", &Info::iridescence, &Patch::iridescence);
  visit("iridescence_ior", &Info::iridescence_ior, &Patch::iridescence_ior);
  visit("iridescence_thickness_minimum", &Info::iridescence_thickness_minimum,
        &Patch::iridescence_thickness_minimum);
  visit("iridescence_thickness_maximum", &Info::iridescence_thickness_maximum,
        &Patch::iridescence_thickness_maximum);
  visit("anisotropy", &Info::anisotropy, &Patch::anisotropy);
  visit("anisotropy_rotation", &Info::anisotropy_rotation, &Patch::anisotropy_rotation);
  visit("diffuse_transmission", &Info::diffuse_transmission, &Patch::diffuse_transmission);
  visit("diffuse_transmission_color", &Info::diffuse_transmission_color,
        &Patch::diffuse_transmission_color);
  visit("transmission", &Info::transmission, &Patch::transmission);
  visit("thickness", &Info::thickness, &Patch::thickness);
  visit("attenuation_distance", &Info::attenuation_distance, &Patch::attenuation_distance);
  visit("attenuation_color", &Info::attenuation_color, &Patch::attenuation_color);
  visit("dispersion", &Info::dispersion, &Patch::dispersion);
}

bool is_unlit(const shared::Material& material) {
  return (material.flags & shared::material_unlit) != 0;
}

bool has_mask(const shared::Material& material) {
  return (material.flags & shared::material_alpha_mask) != 0;
}

bool transmits(const FileMaterial& material) {
  return material.extensions.transmission > 0.0f && !has_mask(material.device);
}

void describe_extensions(const FileMaterial& material, MaterialInfo& info) {
  const scene::MaterialLayers& from = material.extensions;
  info.ior = material.device.ior;
  info.specular = from.specular;
  info.specular_color = to_protocol(from.specular_color);
  info.clearcoat = from.clearcoat;
  info.clearcoat_roughness = from.clearcoat_roughness;
  info.clearcoat_normal_scale = from.clearcoat_normal_scale;
  info.sheen_color = to_protocol(from.sheen_color);
  info.sheen_roughness = from.sheen_roughness;
  info.iridescence = from.iridescence;
  info.iridescence_ior = from.iridescence_ior;
  info.iridescence_thickness_minimum = from.iridescence_thickness_minimum;
  info.iridescence_thickness_maximum = from.iridescence_thickness_maximum;
  info.anisotropy = from.anisotropy;
  info.anisotropy_rotation = from.anisotropy_rotation;
  info.diffuse_transmission = from.diffuse_transmission;
  info.diffuse_transmission_color = to_protocol(from.diffuse_transmission_color);
  // What attenuates transmitted light attenuates light that scatters through, too, which every lit
  // material may let pass.
  info.thickness = from.thickness;
  info.attenuation_distance = from.attenuation_distance;
  info.attenuation_color = to_protocol(from.attenuation_color);
  if (!transmits(material)) return;
  info.transmission = from.transmission;
  info.dispersion = from.dispersion;
}

void name_textures(const FileMaterial& material, MaterialInfo& info) {
  const shared::Material& base = material.device;
  const scene::MaterialLayers& more = material.extensions;
  const std::array slots{
      std::pair{"base_color", &base.base_color_texture},
      std::pair{"metallic_roughness", &base.metallic_roughness_texture},
      std::pair{"normal", &base.normal_texture},
      std::pair{"occlusion", &base.occlusion_texture},
      std::pair{"emissive", &base.emissive_texture},
      std::pair{"specular", &more.specular_texture},
      std::pair{"specular_color", &more.specular_color_texture},
      std::pair{"clearcoat", &more.clearcoat_texture},
      std::pair{"clearcoat_roughness", &more.clearcoat_roughness_texture},
      std::pair{"clearcoat_normal", &more.clearcoat_normal_texture},
      std::pair{"sheen_color", &more.sheen_color_texture},
      std::pair{"sheen_roughness", &more.sheen_roughness_texture},
      std::pair{"transmission", &more.transmission_texture},
      std::pair{"thickness", &more.thickness_texture},
      std::pair{"iridescence", &more.iridescence_texture},
      std::pair{"iridescence_thickness", &more.iridescence_thickness_texture},
      std::pair{"anisotropy", &more.anisotropy_texture},
      std::pair{"diffuse_transmission", &more.diffuse_transmission_texture},
      std::pair{"diffuse_transmission_color", &more.diffuse_transmission_color_texture}};
  for (const auto& [name, slot] : slots) {
    if (slot->texture != shared::no_texture) info.textures.emplace_back(name);
  }
}

/// A member that the material cannot have.
protocol::Error absent(const char* name, const MaterialInfo& initial) {
  return error::invalid(std::string("patch.") + name,
                        initial.ior ? "needs a material that transmits light in its file "
                                      "(KHR_materials_transmission, without an alpha mask)"
                                    : "is not a member of unlit materials (KHR_materials_unlit)");
}

}  // namespace

FileMaterial file_material(const scene::Scene& scene, std::size_t index) {
  const bool extended = index < scene.material_layers.size();
  return {scene.materials[index],
          extended ? scene.material_layers[index] : scene::MaterialLayers()};
}

MaterialInfo describe(const FileMaterial& material) {
  const shared::Material& device = material.device;
  MaterialInfo info;
  info.base_color = to_protocol(glm::vec3(device.base_color));
  info.roughness = device.roughness;
  info.metallic = device.metallic;
  info.emissive = to_protocol(device.emissive);
  info.normal_scale = device.normal_scale;
  info.occlusion_strength = device.occlusion_strength;
  if (has_mask(device)) info.alpha_cutoff = device.alpha_cutoff;
  if (!is_unlit(device)) describe_extensions(material, info);
  name_textures(material, info);
  return info;
}

shared::Material device_form(const MaterialInfo& info, shared::Material material) {
  material.base_color = glm::vec4(from_protocol(info.base_color), material.base_color.w);
  material.roughness = info.roughness;
  material.metallic = info.metallic;
  material.emissive = from_protocol(info.emissive);
  material.normal_scale = info.normal_scale;
  material.occlusion_strength = info.occlusion_strength;
  material.ior = info.ior.value_or(material.ior);
  return material;
}

scene::MaterialLayers extensions_form(const MaterialInfo& info, scene::MaterialLayers layers) {
  const auto number = [](const std::optional<float>& from, float& to) { to = from.value_or(to); };
  const auto color = [](const std::optional<protocol::Vec3>& from, glm::vec3& to) {
    if (from) to = from_protocol(*from);
  };
  number(info.specular, layers.specular);
  color(info.specular_color, layers.specular_color);
  number(info.clearcoat, layers.clearcoat);
  number(info.clearcoat_roughness, layers.clearcoat_roughness);
  number(info.clearcoat_normal_scale, layers.clearcoat_normal_scale);
  color(info.sheen_color, layers.sheen_color);
  number(info.sheen_roughness, layers.sheen_roughness);
  number(info.iridescence, layers.iridescence);
  number(info.iridescence_ior, layers.iridescence_ior);
  number(info.iridescence_thickness_minimum, layers.iridescence_thickness_minimum);
  number(info.iridescence_thickness_maximum, layers.iridescence_thickness_maximum);
  number(info.anisotropy, layers.anisotropy);
  number(info.anisotropy_rotation, layers.anisotropy_rotation);
  number(info.diffuse_transmission, layers.diffuse_transmission);
  color(info.diffuse_transmission_color, layers.diffuse_transmission_color);
  number(info.transmission, layers.transmission);
  number(info.thickness, layers.thickness);
  number(info.attenuation_distance, layers.attenuation_distance);
  color(info.attenuation_color, layers.attenuation_color);
  number(info.dispersion, layers.dispersion);
  return layers;
}

shared::MaterialLayer layer_form(const MaterialInfo& info, const FileMaterial& file) {
  return scene::layer_of(device_form(info, file.device), extensions_form(info, file.extensions));
}

bool same_extensions(const MaterialInfo& a, const MaterialInfo& b) {
  bool same = true;
  visit_extension_factors(
      [&](const char*, auto member, auto) { same = same && a.*member == b.*member; });
  return same;
}

Result<MaterialInfo> patched(MaterialInfo material, const MaterialInfo& initial,
                             const MaterialPatch& patch) {
  if (patch.ior.value && *patch.ior.value > 0.0f && *patch.ior.value < 1.0f) {
    return error::invalid("patch.ior", "must be 0, or 1 and more");
  }
  visit_base_factors([&](const char*, auto member, auto change) {
    apply_change(patch.*change, material.*member, initial.*member);
  });
  std::optional<protocol::Error> refused;
  visit_extension_factors([&](const char* name, auto member, auto change) {
    const auto& asked = patch.*change;
    if (initial.*member) {
      apply_change(asked, material.*member, initial.*member);
    } else if ((asked.value || asked.reset) && !refused) {
      refused = absent(name, initial);
    }
  });
  if (refused) return *refused;
  return material;
}

MaterialPatch patch_of(const MaterialInfo& material) {
  MaterialPatch patch;
  const auto take = [&](const char* name, auto member, auto change) {
    const bool differs = std::ranges::find(material.changed, name) != material.changed.end();
    if (differs) (patch.*change).value = material.*member;
  };
  visit_base_factors(take);
  visit_extension_factors(take);
  return patch;
}

}  // namespace heliograph::session
