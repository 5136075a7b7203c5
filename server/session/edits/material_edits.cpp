#include "session/edits/material_edits.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "session/edits/edited_parts.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::MaterialInfo;
using protocol::Result;

namespace {

shared::Material device_form(const MaterialInfo& info, shared::Material material) {
  material.base_color = glm::vec4(from_protocol(info.base_color), material.base_color.w);
  material.roughness = info.roughness;
  material.metallic = info.metallic;
  material.emissive = from_protocol(info.emissive);
  material.normal_scale = info.normal_scale;
  material.occlusion_strength = info.occlusion_strength;
  return material;
}

MaterialInfo describe(const shared::Material& material) {
  MaterialInfo info{.name = {},
                    .base_color = to_protocol(glm::vec3(material.base_color)),
                    .roughness = material.roughness,
                    .metallic = material.metallic,
                    .emissive = to_protocol(material.emissive),
                    .normal_scale = material.normal_scale,
                    .occlusion_strength = material.occlusion_strength,
                    .textures = {}};
  const std::array slots{std::pair{"base_color", &material.base_color_texture},
                         std::pair{"metallic_roughness", &material.metallic_roughness_texture},
                         std::pair{"normal", &material.normal_texture},
                         std::pair{"occlusion", &material.occlusion_texture},
                         std::pair{"emissive", &material.emissive_texture}};
  for (const auto& [name, slot] : slots) {
    if (slot->texture != shared::no_texture) info.textures.emplace_back(name);
  }
  return info;
}

/// The patch that leads to `material` from that of the file.
protocol::MaterialPatch patch_of(const MaterialInfo& material) {
  protocol::MaterialPatch patch;
  const auto take = [&](const char* name, auto& change, const auto& value) {
    if (std::ranges::find(material.changed, name) != material.changed.end()) change.value = value;
  };
  take("base_color", patch.base_color, material.base_color);
  take("roughness", patch.roughness, material.roughness);
  take("metallic", patch.metallic, material.metallic);
  take("emissive", patch.emissive, material.emissive);
  take("normal_scale", patch.normal_scale, material.normal_scale);
  take("occlusion_strength", patch.occlusion_strength, material.occlusion_strength);
  return patch;
}

}  // namespace

std::vector<MaterialInfo> describe_materials(const scene::Scene& scene) {
  UniqueNames names("material");
  std::vector<MaterialInfo> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    materials.push_back(describe(scene.materials[i]));
    const bool named = i < scene.material_names.size();
    materials.back().name = names.next(named ? scene.material_names[i] : std::string());
  }
  return materials;
}

MaterialEdits::MaterialEdits(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)), materials_(describe_materials(*scene_)) {}

Result<MaterialInfo> MaterialEdits::patch(const protocol::MaterialsPatch& request) {
  const auto found = std::ranges::find(materials_, request.material, &MaterialInfo::name);
  if (found == materials_.end()) {
    std::vector<std::string_view> names;
    for (const MaterialInfo& material : materials_) names.push_back(material.name);
    return no_such_part("material", request.material, names);
  }
  const auto index = static_cast<std::size_t>(found - materials_.begin());
  MaterialInfo initial = describe(scene_->materials[index]);
  initial.name = found->name;
  const protocol::MaterialPatch& patch = request.patch;
  MaterialInfo material = *found;
  apply_change(patch.base_color, material.base_color, initial.base_color);
  apply_change(patch.roughness, material.roughness, initial.roughness);
  apply_change(patch.metallic, material.metallic, initial.metallic);
  apply_change(patch.emissive, material.emissive, initial.emissive);
  apply_change(patch.normal_scale, material.normal_scale, initial.normal_scale);
  apply_change(patch.occlusion_strength, material.occlusion_strength, initial.occlusion_strength);
  if (material == *found) return material;
  material.changed = differences(material, initial);
  *found = material;
  auto materials = std::make_shared<Materials>(device_ ? *device_ : scene_->materials);
  (*materials)[index] = device_form(material, scene_->materials[index]);
  device_ = std::move(materials);
  return material;
}

void MaterialEdits::describe_edits(protocol::EditDocument& document) const {
  for (const MaterialInfo& material : materials_) {
    if (material.changed.empty()) continue;
    document.materials.push_back({material.name, patch_of(material)});
  }
}

Result<void> MaterialEdits::apply(const protocol::EditDocument& document) {
  for (std::size_t i = 0; i < document.materials.size(); ++i) {
    const auto patched = patch(document.materials[i]);
    if (!patched) return below(patched.error(), "edits.materials[" + std::to_string(i) + "]");
  }
  return {};
}

}  // namespace heliograph::session
