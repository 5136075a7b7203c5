#include "scene/gltf/export/node_export.hpp"

#include <optional>
#include <string>
#include <vector>

#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

constexpr const char* visibility_extension = "KHR_node_visibility";

/// By node: whether a light is on it or below it.
std::vector<bool> nodes_with_lights(const Scene& scene) {
  std::vector<bool> lit(scene.nodes.size());
  for (const Light& light : scene.lights) {
    for (std::optional<std::uint32_t> node = light.node; node; node = scene.nodes[*node].parent) {
      lit[*node] = true;
    }
  }
  return lit;
}

std::vector<bool> nodes_with_meshes(const Scene& scene) {
  std::vector<bool> result(scene.nodes.size());
  for (const Instance& instance : scene.instances) result[instance.node] = true;
  for (const Deformation& deformation : scene.deformations) result[deformation.node] = true;
  return result;
}

}  // namespace

void export_hidden(EditableDocument& document, const Scene& scene, DocumentNodes nodes,
                   std::span<const std::uint32_t> hidden) {
  if (hidden.empty()) return;
  const std::vector<bool> lit = nodes_with_lights(scene);
  const std::vector<bool> drawn = nodes_with_meshes(scene);
  std::vector<bool> asked(scene.nodes.size());
  for (const std::uint32_t node : hidden) asked[node] = true;
  std::vector<bool> done(scene.nodes.size());  // by the node itself or one above
  // Parents come first.
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const auto parent = scene.nodes[i].parent;
    asked[i] = asked[i] || (parent && asked[*parent]);
    done[i] = parent && done[*parent];
    if (!asked[i] || done[i]) continue;
    if (nodes[i] && !lit[i]) {
      document.node(*nodes[i])["extensions"][visibility_extension]["visible"] = false;
      document.use(visibility_extension);
      done[i] = true;
    } else if (drawn[i]) {
      document.warn("node " + in_quotes(scene.nodes[i].name) +
                    (lit[i] ? " is hidden, but lights below it are not: it is visible in the file"
                            : " is one of several instances: it is visible in the file"));
    }
  }
}

}  // namespace heliograph::scene
