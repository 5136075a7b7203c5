#include "session/edits/material_edits.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "scene/animation/tracks.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/texture_override.hpp"
#include "session/edits/edited_parts.hpp"
#include "session/edits/material_form.hpp"

namespace heliograph::session {

using protocol::MaterialInfo;
using protocol::Result;

std::vector<MaterialInfo> describe_materials(const scene::Scene& scene) {
  const std::vector<std::string> names =
      scene::material_labels(scene.material_names, scene.materials.size());
  std::vector<MaterialInfo> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    materials.push_back(describe(file_material(scene, i)));
    materials.back().name = names[i];
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
  const FileMaterial file = file_material(*scene_, index);
  MaterialInfo initial = describe(file);
  initial.name = found->name;
  Result<MaterialInfo> patched = session::patched(*found, initial, request.patch);
  if (!patched || *patched == *found) return patched;
  MaterialInfo& material = *patched;
  material.changed = differences(material, initial);
  *found = material;
  auto materials = std::make_shared<Materials>(device_ ? *device_ : scene_->materials);
  shared::Material& device = (*materials)[index] = device_form(material, file.device);
  if (!same_extensions(material, initial)) {
    device.layer = own_layer(index, layer_form(material, file));
  }
  device_ = std::move(materials);
  if (scene::has_tracks(*scene_)) {
    shared_list_ = std::make_shared<const std::vector<MaterialInfo>>(materials_);
  }
  return patched;
}

/// The number of a layer of the material of this number alone.
std::uint32_t MaterialEdits::own_layer(std::size_t material, const shared::MaterialLayer& layer) {
  if (scene::adds_nothing(layer)) return 0;
  auto layers = std::make_shared<Layers>(device_layers_ ? *device_layers_ : scene_->layers);
  if (layers->empty()) layers->push_back(scene::plain_layer());
  const auto next = static_cast<std::uint32_t>(layers->size());
  const std::uint32_t number = own_layers_.try_emplace(material, next).first->second;
  if (number == next) layers->emplace_back();
  (*layers)[number] = layer;
  device_layers_ = std::move(layers);
  return number;
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
