#include "session/edits/scene_export.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "session/edits/material_form.hpp"

namespace heliograph::session {
namespace {

/// By node: whether it is above one of these.
std::vector<bool> nodes_above(const scene::Scene& scene, const std::vector<std::uint32_t>& nodes) {
  std::vector<bool> above(scene.nodes.size());
  for (const std::uint32_t node : nodes) {
    std::optional<std::uint32_t> parent = scene.nodes[node].parent;
    for (; parent && !above[*parent]; parent = scene.nodes[*parent].parent) above[*parent] = true;
  }
  return above;
}

/// The hidden nodes, and those that isolated ones leave out.
void add_hidden(const scene::Scene& scene, const NodeState& nodes, SceneExport& made) {
  made.changes.hidden = nodes.hidden();
  if (nodes.isolated().empty()) return;
  const std::vector<bool> inside = nodes.within(nodes.isolated());
  const std::vector<bool> above = nodes_above(scene, nodes.isolated());
  for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
    if (!inside[i] && !above[i]) made.changes.hidden.push_back(i);
  }
  for (const std::uint32_t node : nodes_of_instances(scene)) {
    if (inside[node] || !above[node]) continue;
    made.warnings.emplace_back(
        "isolated nodes: meshes of nodes above them are visible in the file");
    return;
  }
}

/// Those of materials whose extensions differ from the file.
std::vector<std::optional<scene::MaterialLayers>> edited_extensions(const scene::Scene& scene,
                                                                    const SceneEdits& edits) {
  std::vector<std::optional<scene::MaterialLayers>> extensions;
  for (const protocol::MaterialInfo& material : edits.materials()) {
    const FileMaterial file = file_material(scene, extensions.size());
    extensions.emplace_back();
    if (same_extensions(material, describe(file))) continue;
    extensions.back() = extensions_form(material, file.extensions);
  }
  return extensions;
}

}  // namespace

SceneExport make_export(std::shared_ptr<const scene::Scene> scene, const SceneEdits& edits,
                        const NodeState& nodes, const SectionPlanes& section,
                        bool other_environment) {
  SceneExport made{.scene = std::move(scene), .changes = {}, .warnings = {}};
  if (edits.device_materials()) {
    made.changes.materials = *edits.device_materials();
    made.changes.extensions = edited_extensions(*made.scene, edits);
  }
  if (edits.device_lights()) made.changes.lights = edits.light_changes();
  add_hidden(*made.scene, nodes, made);
  if (section.enabled()) made.warnings.emplace_back("section planes: glTF has none");
  if (other_environment) {
    made.warnings.emplace_back("environment: glTF has none; it stays a file of its own");
  }
  return made;
}

}  // namespace heliograph::session
