#include "session/nodes/node_properties.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "session/edits/scene_edits.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {
namespace {

bool contains_in_any_case(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return !std::ranges::search(text, part, same).empty();
}

/// Calls `visit(instance number, instance)` for those at `nodes` or below.
template <class Visit>
void for_each_instance(const scene::Scene& scene, const NodeState& state,
                       std::span<const std::uint32_t> nodes, const Visit& visit) {
  const std::vector<bool> inside = state.within(nodes);
  const std::vector<std::uint32_t> node_of = nodes_of_instances(scene);
  for (std::size_t i = 0; i < node_of.size(); ++i) {
    if (inside[node_of[i]]) visit(i, scene.instances[i]);
  }
}

}  // namespace

protocol::NodeList list_nodes(const scene::Scene& scene, const NodeState& state,
                              const protocol::NodesList& request) {
  const std::vector<std::string> names = node_names(scene);
  std::vector<std::uint32_t> meshes(scene.nodes.size());
  for (const std::uint32_t node : nodes_of_instances(scene)) ++meshes[node];
  protocol::NodeList list;
  list.isolated = state.isolated();
  for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
    if (request.search && !contains_in_any_case(names[i], *request.search)) continue;
    const std::uint32_t place = list.total++;
    if (place < request.first || list.nodes.size() >= request.count) continue;
    list.nodes.push_back({.id = i,
                          .parent = scene.nodes[i].parent,
                          .name = names[i],
                          .meshes = meshes[i],
                          .visible = state.is_visible(i)});
  }
  return list;
}

protocol::NodeProperties node_properties(const scene::Scene& scene, const NodeState& state,
                                         std::span<const std::uint32_t> nodes) {
  protocol::NodeProperties properties;
  const std::vector<std::string> names = node_names(scene);
  for (const std::uint32_t node : nodes) properties.names.push_back(names[node]);
  std::set<std::uint32_t> materials;
  const auto& hidden = state.hidden_instances();
  for_each_instance(scene, state, nodes, [&](std::size_t i, const scene::Instance& instance) {
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    ++properties.instances;
    properties.triangles += mesh.indices.size() / 3;
    materials.insert(mesh.material);
    properties.shown |= !hidden || !(*hidden)[i];
  });
  const std::vector<protocol::MaterialInfo> all = describe_materials(scene);
  for (const std::uint32_t material : materials) {
    properties.materials.push_back(all[material].name);
  }
  const scene::Bounds bounds = node_bounds(scene, scene::rest_pose(scene), state, nodes);
  if (!bounds.empty()) {
    properties.bounds = {.min = to_protocol(bounds.minimum), .max = to_protocol(bounds.maximum)};
  }
  return properties;
}

scene::Bounds node_bounds(const scene::Scene& scene, const scene::Pose& pose,
                          const NodeState& state, std::span<const std::uint32_t> nodes) {
  scene::Bounds bounds;
  for_each_instance(scene, state, nodes, [&](std::size_t, const scene::Instance& instance) {
    bounds.include(
        scene::world_bounds(scene.meshes[instance.mesh].bounds, pose.worlds[instance.node]));
  });
  return bounds;
}

}  // namespace heliograph::session
