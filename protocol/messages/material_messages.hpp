#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about the materials of a scene: glTF's factors, those of its extensions included. Edits
// belong to one session.

namespace heliograph::protocol {

/// Members of extensions are absent where the material cannot have them: unlit ones have none, and
/// only those whose file lets light through have transmission and all after it.
struct MaterialInfo {
  std::string name;
  Vec3 base_color{};
  float roughness = 0.0f;
  float metallic = 0.0f;
  Vec3 emissive{};
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  std::optional<float> alpha_cutoff;
  std::optional<float> ior;
  std::optional<float> specular;
  std::optional<Vec3> specular_color;
  std::optional<float> clearcoat;
  std::optional<float> clearcoat_roughness;
  std::optional<float> clearcoat_normal_scale;
  std::optional<Vec3> sheen_color;
  std::optional<float> sheen_roughness;
  std::optional<float> iridescence;
  std::optional<float> iridescence_ior;
  std::optional<float> iridescence_thickness_minimum;
  std::optional<float> iridescence_thickness_maximum;
  std::optional<float> anisotropy;
  std::optional<float> anisotropy_rotation;
  std::optional<float> diffuse_transmission;
  std::optional<Vec3> diffuse_transmission_color;
  std::optional<float> transmission;
  std::optional<float> thickness;
  std::optional<float> attenuation_distance;
  std::optional<Vec3> attenuation_color;
  std::optional<float> dispersion;
  std::vector<std::string> textures;
  std::vector<std::string> changed;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &MaterialInfo::name, "Unique name for materials.patch."),
        field("base_color", &MaterialInfo::base_color, "Linear factor on the texture, if any."),
        field("roughness", &MaterialInfo::roughness,
              "Perceptual roughness, factor on the texture, if any."),
        field("metallic", &MaterialInfo::metallic, "Metalness, factor on the texture, if any."),
        field("emissive", &MaterialInfo::emissive,
              "Linear emitted radiance, factor on the texture, if any."),
        field("normal_scale", &MaterialInfo::normal_scale, "Scale of the normal texture."),
        field("occlusion_strength", &MaterialInfo::occlusion_strength,
              "Strength of the occlusion texture."),
        field("alpha_cutoff", &MaterialInfo::alpha_cutoff,
              "Opacity below which there is a hole, of materials with an alpha mask."),
        field("ior", &MaterialInfo::ior, "Index of refraction; 0: it reflects all light."),
        field("specular", &MaterialInfo::specular,
              "Strength of the dielectric reflection, factor on the texture, if any."),
        field("specular_color", &MaterialInfo::specular_color,
              "Linear colour of the dielectric reflection, factor on the texture, if any."),
        field("clearcoat", &MaterialInfo::clearcoat,
              "Fraction under a clear coat, factor on the texture, if any."),
        field("clearcoat_roughness", &MaterialInfo::clearcoat_roughness,
              "Perceptual roughness of the clear coat, factor on the texture, if any."),
        field("clearcoat_normal_scale", &MaterialInfo::clearcoat_normal_scale,
              "Scale of the clear coat's normal texture."),
        field("sheen_color", &MaterialInfo::sheen_color,
              "Linear colour of the sheen, factor on the texture, if any; black: none."),
        field("sheen_roughness", &MaterialInfo::sheen_roughness,
              "Perceptual roughness of the sheen, factor on the texture, if any."),
        field("iridescence", &MaterialInfo::iridescence,
              "Fraction under a thin film, factor on the texture, if any."),
        field("iridescence_ior", &MaterialInfo::iridescence_ior,
              "Index of refraction of the film."),
        field("iridescence_thickness_minimum", &MaterialInfo::iridescence_thickness_minimum,
              "Thickness of the film where its texture is 0.")
            .unit("nanometres"),
        field("iridescence_thickness_maximum", &MaterialInfo::iridescence_thickness_maximum,
              "Thickness of the film where its texture is 1, and without a texture.")
            .unit("nanometres"),
        field("anisotropy", &MaterialInfo::anisotropy,
              "How much rougher the surface is in one direction, factor on the texture, if any."),
        field("anisotropy_rotation", &MaterialInfo::anisotropy_rotation,
              "Of that direction, from the tangent or the texture's direction to the bitangent.")
            .unit("radians"),
        field("diffuse_transmission", &MaterialInfo::diffuse_transmission,
              "Fraction of the diffuse light that leaves at the other side, factor on the texture, "
              "if any."),
        field("diffuse_transmission_color", &MaterialInfo::diffuse_transmission_color,
              "Linear colour of that light, factor on the texture, if any."),
        field("transmission", &MaterialInfo::transmission,
              "Fraction of light that passes, factor on the texture, if any."),
        field("thickness", &MaterialInfo::thickness,
              "Thickness below the surface in the mesh's space, factor on the texture, if any; 0: "
              "thin walled.")
            .unit("metres"),
        field("attenuation_distance", &MaterialInfo::attenuation_distance,
              "Distance after which light has the attenuation colour; 0: infinite.")
            .unit("metres"),
        field("attenuation_color", &MaterialInfo::attenuation_color,
              "Linear colour of white light after the attenuation distance."),
        field("dispersion", &MaterialInfo::dispersion,
              "How far the colours are bent apart: 20 / Abbe number."),
        field("textures", &MaterialInfo::textures, "Members that have a texture."),
        field("changed", &MaterialInfo::changed, "Members that differ from the scene file."),
    };
  }
  bool operator==(const MaterialInfo&) const = default;
};

struct MaterialList {
  std::vector<MaterialInfo> materials;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("materials", &MaterialList::materials,
              "The materials of the scene with the session's edits."),
        field("rev", &MaterialList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const MaterialList&) const = default;
};

struct MaterialPatch {
  static constexpr bool strict = true;
  Change<Vec3> base_color;
  Change<float> roughness;
  Change<float> metallic;
  Change<Vec3> emissive;
  Change<float> normal_scale;
  Change<float> occlusion_strength;
  Change<float> ior;
  Change<float> specular;
  Change<Vec3> specular_color;
  Change<float> clearcoat;
  Change<float> clearcoat_roughness;
  Change<float> clearcoat_normal_scale;
  Change<Vec3> sheen_color;
  Change<float> sheen_roughness;
  Change<float> iridescence;
  Change<float> iridescence_ior;
  Change<float> iridescence_thickness_minimum;
  Change<float> iridescence_thickness_maximum;
  Change<float> anisotropy;
  Change<float> anisotropy_rotation;
  Change<float> diffuse_transmission;
  Change<Vec3> diffuse_transmission_color;
  Change<float> transmission;
  Change<float> thickness;
  Change<float> attenuation_distance;
  Change<Vec3> attenuation_color;
  Change<float> dispersion;

  static constexpr auto fields() {
    return std::tuple{
        field("base_color", &MaterialPatch::base_color, "Linear factor.").range(0, 1),
        field("roughness", &MaterialPatch::roughness, "Perceptual roughness.").range(0, 1),
        field("metallic", &MaterialPatch::metallic, "Metalness.").range(0, 1),
        field("emissive", &MaterialPatch::emissive, "Linear emitted radiance.").range(0, 1e6),
        field("normal_scale", &MaterialPatch::normal_scale, "Scale of the normal texture.")
            .range(0, 16),
        field("occlusion_strength", &MaterialPatch::occlusion_strength,
              "Strength of the occlusion texture.")
            .range(0, 1),
        field("ior", &MaterialPatch::ior,
              "Index of refraction: 1 and more, or 0: all light is reflected.")
            .range(0, 10),
        field("specular", &MaterialPatch::specular, "Strength of the dielectric reflection.")
            .range(0, 1),
        field("specular_color", &MaterialPatch::specular_color,
              "Linear colour of the dielectric reflection.")
            .range(0, 1000),
        field("clearcoat", &MaterialPatch::clearcoat, "Fraction under a clear coat.").range(0, 1),
        field("clearcoat_roughness", &MaterialPatch::clearcoat_roughness,
              "Perceptual roughness of the clear coat.")
            .range(0, 1),
        field("clearcoat_normal_scale", &MaterialPatch::clearcoat_normal_scale,
              "Scale of the clear coat's normal texture.")
            .range(0, 16),
        field("sheen_color", &MaterialPatch::sheen_color, "Linear colour of the sheen.")
            .range(0, 1),
        field("sheen_roughness", &MaterialPatch::sheen_roughness,
              "Perceptual roughness of the sheen.")
            .range(0, 1),
        field("iridescence", &MaterialPatch::iridescence, "Fraction under a thin film.")
            .range(0, 1),
        field("iridescence_ior", &MaterialPatch::iridescence_ior,
              "Index of refraction of the film.")
            .range(1, 10),
        field("iridescence_thickness_minimum", &MaterialPatch::iridescence_thickness_minimum,
              "Thickness of the film where its texture is 0.")
            .range(0, 1e5)
            .unit("nanometres"),
        field("iridescence_thickness_maximum", &MaterialPatch::iridescence_thickness_maximum,
              "Thickness of the film where its texture is 1, and without a texture.")
            .range(0, 1e5)
            .unit("nanometres"),
        field("anisotropy", &MaterialPatch::anisotropy,
              "How much rougher the surface is in one direction.")
            .range(0, 1),
        field("anisotropy_rotation", &MaterialPatch::anisotropy_rotation,
              "Of that direction, from the tangent or the texture's direction to the bitangent.")
            .range(-6.5, 6.5)
            .unit("radians"),
        field("diffuse_transmission", &MaterialPatch::diffuse_transmission,
              "Fraction of the diffuse light that leaves at the other side.")
            .range(0, 1),
        field("diffuse_transmission_color", &MaterialPatch::diffuse_transmission_color,
              "Linear colour of that light.")
            .range(0, 1),
        field("transmission", &MaterialPatch::transmission,
              "Fraction of light that passes, of materials whose file lets light through.")
            .range(0, 1),
        field("thickness", &MaterialPatch::thickness,
              "Thickness in the mesh's space; 0: thin walled.")
            .range(0, 1e6)
            .unit("metres"),
        field("attenuation_distance", &MaterialPatch::attenuation_distance,
              "Distance after which light has the attenuation colour; 0: infinite.")
            .range(0, 1e6)
            .unit("metres"),
        field("attenuation_color", &MaterialPatch::attenuation_color,
              "Linear colour of white light after the attenuation distance.")
            .range(0, 1),
        field("dispersion", &MaterialPatch::dispersion,
              "How far the colours are bent apart: 20 / Abbe number.")
            .range(0, 20),
    };
  }
  bool operator==(const MaterialPatch&) const = default;
};

struct MaterialsPatch {
  std::string material;
  MaterialPatch patch;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialsPatch::material, "A name from materials.list.")
            .length(1, max_node_name),
        field("patch", &MaterialsPatch::patch,
              "A merge patch (RFC 7386); null restores the value of the scene file."),
    };
  }
  bool operator==(const MaterialsPatch&) const = default;
};

struct MaterialState {
  MaterialInfo material;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialState::material, "The material after the change."),
        field("rev", &MaterialState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const MaterialState&) const = default;
};

struct MaterialsChanged {
  MaterialInfo material;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialsChanged::material, "The material after the change."),
        field("rev", &MaterialsChanged::rev, "Revision of the session's state."),
        field("by", &MaterialsChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const MaterialsChanged&) const = default;
};

}  // namespace heliograph::protocol
