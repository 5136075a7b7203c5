#include "scene/gltf/export/material_export.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

constexpr const char* strength_extension = "KHR_materials_emissive_strength";
constexpr const char* glossiness_extension = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* variants_extension = "KHR_materials_variants";

template <class Visit>
void visit_primitives(EditableDocument& document, const Visit& visit) {
  for (json& mesh : document.list("meshes")) {
    for (json& primitive : mesh["primitives"]) visit(primitive);
  }
}

/// The material of primitives that have none.
json& add_default_material(EditableDocument& document) {
  const std::size_t index = document.append("materials", {{"name", "default"}});
  visit_primitives(document, [&](json& primitive) {
    if (!primitive.contains("material")) primitive["material"] = index;
  });
  return document.list("materials")[index];
}

bool has_other_surface(const shared::Material& a, const shared::Material& b) {
  return a.base_color != b.base_color || a.metallic != b.metallic || a.roughness != b.roughness;
}

void write_emission(EditableDocument& document, json& material, const glm::vec3& emissive) {
  const float most = std::max({emissive.x, emissive.y, emissive.z});
  // A power of two: the factors times it are the emission to the last bit.
  const float strength = most > 1.0f ? std::exp2(std::ceil(std::log2(most))) : 1.0f;
  const glm::vec3 factor = emissive / strength;
  material["emissiveFactor"] = {factor.x, factor.y, factor.z};
  if (strength == 1.0f) return erase_within(material, "extensions", strength_extension);
  material["extensions"][strength_extension]["emissiveStrength"] = strength;
  document.use(strength_extension);
}

/// Whether the core material is what is shown; one of the specular-glossiness model without
/// textures becomes it.
bool shows_core_material(EditableDocument& document, json& material, const std::string& name,
                         const shared::Material& before) {
  const auto extensions = material.find("extensions");
  if (extensions == material.end() || !extensions->contains(glossiness_extension)) return true;
  if (before.base_color_texture.texture != shared::no_texture) {
    document.warn("material " + in_quotes(name) +
                  ": colour, metalness and roughness stay as in the file, since its textures are "
                  "those of KHR_materials_pbrSpecularGlossiness");
    return false;
  }
  erase_within(material, "extensions", glossiness_extension);
  material.erase("pbrMetallicRoughness");
  return true;
}

void write_surface(json& material, const shared::Material& now) {
  json& surface = material["pbrMetallicRoughness"];
  surface["baseColorFactor"] = {now.base_color.x, now.base_color.y, now.base_color.z,
                                now.base_color.w};
  surface["metallicFactor"] = now.metallic;
  surface["roughnessFactor"] = now.roughness;
}

/// A member of a texture slot, which is without effect where the material has no such texture.
void write_slot(json& material, const char* slot, const char* member, float value) {
  const auto found = material.find(slot);
  if (found != material.end()) (*found)[member] = value;
}

/// Factors of one extension; those of a material without it are written where they do something.
void write_extension(EditableDocument& document, json& material, const char* name, bool needed,
                     const json& factors) {
  const auto extensions = material.find("extensions");
  const bool there = extensions != material.end() && extensions->contains(name);
  if (!there && !needed) return;
  material["extensions"][name].update(factors);
  document.use(name);
}

void write_material(EditableDocument& document, json& material, const std::string& name,
                    const shared::Material& before, const shared::Material& now) {
  if (has_other_surface(before, now) && shows_core_material(document, material, name, before)) {
    write_surface(material, now);
  }
  if (before.emissive != now.emissive) write_emission(document, material, now.emissive);
  if (before.normal_scale != now.normal_scale) {
    write_slot(material, "normalTexture", "scale", now.normal_scale);
  }
  if (before.occlusion_strength != now.occlusion_strength) {
    write_slot(material, "occlusionTexture", "strength", now.occlusion_strength);
  }
  if (before.ior != now.ior) {
    write_extension(document, material, "KHR_materials_ior", true, {{"ior", now.ior}});
  }
}

json triple(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

void write_volume(EditableDocument& document, json& material, const MaterialLayers& now) {
  json factors{{"thicknessFactor", now.thickness},
               {"attenuationColor", triple(now.attenuation_color)}};
  // Without a distance it is infinite.
  if (now.attenuation_distance > 0.0f) factors["attenuationDistance"] = now.attenuation_distance;
  constexpr const char* name = "KHR_materials_volume";
  write_extension(document, material, name, now.thickness > 0.0f, factors);
  const auto extensions = material.find("extensions");
  if (now.attenuation_distance > 0.0f || extensions == material.end()) return;
  if (extensions->contains(name)) (*extensions)[name].erase("attenuationDistance");
}

void write_extensions(EditableDocument& document, json& material, const MaterialLayers& now) {
  const bool specular = now.specular != 1.0f || now.specular_color != glm::vec3(1.0f);
  write_extension(
      document, material, "KHR_materials_specular", specular,
      {{"specularFactor", now.specular}, {"specularColorFactor", triple(now.specular_color)}});
  constexpr const char* coat = "KHR_materials_clearcoat";
  write_extension(
      document, material, coat, now.clearcoat > 0.0f,
      {{"clearcoatFactor", now.clearcoat}, {"clearcoatRoughnessFactor", now.clearcoat_roughness}});
  write_extension(document, material, "KHR_materials_sheen", now.sheen_color != glm::vec3(0.0f),
                  {{"sheenColorFactor", triple(now.sheen_color)},
                   {"sheenRoughnessFactor", now.sheen_roughness}});
  write_extension(document, material, "KHR_materials_iridescence", now.iridescence > 0.0f,
                  {{"iridescenceFactor", now.iridescence},
                   {"iridescenceIor", now.iridescence_ior},
                   {"iridescenceThicknessMinimum", now.iridescence_thickness_minimum},
                   {"iridescenceThicknessMaximum", now.iridescence_thickness_maximum}});
  write_extension(
      document, material, "KHR_materials_anisotropy", now.anisotropy > 0.0f,
      {{"anisotropyStrength", now.anisotropy}, {"anisotropyRotation", now.anisotropy_rotation}});
  write_extension(document, material, "KHR_materials_dispersion", now.dispersion > 0.0f,
                  {{"dispersion", now.dispersion}});
  write_extension(document, material, "KHR_materials_diffuse_transmission",
                  now.diffuse_transmission > 0.0f,
                  {{"diffuseTransmissionFactor", now.diffuse_transmission},
                   {"diffuseTransmissionColorFactor", triple(now.diffuse_transmission_color)}});
  write_extension(document, material, "KHR_materials_transmission", now.transmission > 0.0f,
                  {{"transmissionFactor", now.transmission}});
  write_volume(document, material, now);
  const auto extensions = material.find("extensions");
  if (extensions == material.end() || !extensions->contains(coat)) return;
  write_slot((*extensions)[coat], "clearcoatNormalTexture", "scale", now.clearcoat_normal_scale);
}

bool differs_in_factors(const shared::Material& a, const shared::Material& b) {
  return has_other_surface(a, b) || a.emissive != b.emissive || a.normal_scale != b.normal_scale ||
         a.occlusion_strength != b.occlusion_strength || a.ior != b.ior;
}

}  // namespace

json& material_of(EditableDocument& document, std::size_t index) {
  const bool in_file = index < document.list("materials").size();
  return in_file ? document.list("materials")[index] : add_default_material(document);
}

void export_variant(EditableDocument& document, const Scene& scene) {
  if (!scene.variant) return;
  visit_primitives(document, [&](json& primitive) {
    const auto extensions = primitive.find("extensions");
    if (extensions == primitive.end() || !extensions->contains(variants_extension)) return;
    for (const json& mapping : (*extensions)[variants_extension].value("mappings", json::array())) {
      const json& variants = mapping.at("variants");
      const bool maps = std::ranges::any_of(
          variants, [&](const json& variant) { return variant.get<double>() == *scene.variant; });
      if (maps) primitive["material"] = mapping.at("material");
    }
  });
}

void export_materials(EditableDocument& document, const Scene& scene, const SceneChanges& changes) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const shared::Material& before = scene.materials[i];
    const shared::Material& now = changes.materials.empty() ? before : changes.materials[i];
    const bool extended = i < changes.extensions.size() && changes.extensions[i];
    if (!extended && !differs_in_factors(before, now)) continue;
    json& material = material_of(document, i);
    write_material(document, material, scene.material_names[i], before, now);
    if (extended) write_extensions(document, material, *changes.extensions[i]);
  }
}

}  // namespace heliograph::scene
