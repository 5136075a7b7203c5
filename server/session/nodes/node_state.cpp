#include "session/nodes/node_state.hpp"

#include <algorithm>
#include <utility>

namespace heliograph::session {
namespace {

std::vector<std::uint32_t> sorted_once(std::span<const std::uint32_t> nodes) {
  std::vector<std::uint32_t> sorted(nodes.begin(), nodes.end());
  std::ranges::sort(sorted);
  sorted.erase(std::ranges::unique(sorted).begin(), sorted.end());
  return sorted;
}

}  // namespace

std::vector<std::uint32_t> nodes_of_instances(const scene::Scene& scene) {
  std::vector<std::uint32_t> deforming(scene.meshes.size(), ~0u);
  for (const scene::Deformation& it : scene.deformations) deforming[it.mesh] = it.node;
  std::vector<std::uint32_t> nodes;
  for (const auto& [mesh, node] : scene.instances) {
    nodes.push_back(deforming[mesh] == ~0u ? node : deforming[mesh]);
  }
  return nodes;
}

std::vector<std::string> node_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Node& node : scene.nodes) names.push_back(node.name);
  const std::vector<std::uint32_t> nodes = nodes_of_instances(scene);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::string& name = names[nodes[i]];
    if (name.empty()) name = scene.meshes[scene.instances[i].mesh].name;
  }
  return names;
}

NodeState::NodeState(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)),
      node_of_(nodes_of_instances(*scene_)),
      visible_(scene_->nodes.size(), true) {}

protocol::Result<void> NodeState::check(std::span<const std::uint32_t> nodes,
                                        const char* path) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < visible_.size()) continue;
    const std::string limit =
        visible_.empty() ? "no nodes" : "0.." + std::to_string(visible_.size() - 1);
    return protocol::error::invalid(std::string(path) + "[" + std::to_string(i) + "]",
                                    "the scene has no such node", limit);
  }
  return {};
}

bool NodeState::set_visible(std::span<const std::uint32_t> nodes, bool visible) {
  bool changed = false;
  for (const std::uint32_t node : nodes) {
    changed |= visible_[node] != visible;
    visible_[node] = visible;
  }
  if (changed) update_hidden();
  return changed;
}

bool NodeState::isolate(std::span<const std::uint32_t> nodes) {
  std::vector<std::uint32_t> next = sorted_once(nodes);
  if (next == isolated_) return false;
  isolated_ = std::move(next);
  update_hidden();
  return true;
}

bool NodeState::select(std::span<const std::uint32_t> nodes) {
  std::vector<std::uint32_t> next = sorted_once(nodes);
  if (next == selected_) return false;
  selected_ = std::move(next);
  selected_instances_ = nullptr;
  if (selected_.empty()) return true;
  const std::vector<bool> below = within(selected_);
  auto instances = std::make_shared<std::vector<std::uint32_t>>();
  for (std::uint32_t i = 0; i < node_of_.size(); ++i) {
    if (below[node_of_[i]]) instances->push_back(i);
  }
  if (!instances->empty()) selected_instances_ = std::move(instances);
  return true;
}

std::vector<std::uint32_t> NodeState::hidden() const {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < visible_.size(); ++i) {
    if (!visible_[i]) nodes.push_back(i);
  }
  return nodes;
}

// Parents come first.
std::vector<bool> NodeState::within(std::span<const std::uint32_t> nodes) const {
  std::vector<bool> inside(visible_.size());
  for (const std::uint32_t node : nodes) inside[node] = true;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const auto parent = scene_->nodes[i].parent;
    if (parent && inside[*parent]) inside[i] = true;
  }
  return inside;
}

void NodeState::update_hidden() {
  std::vector<bool> shown = visible_;
  const std::vector<bool> isolated = within(isolated_);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto parent = scene_->nodes[i].parent;
    if (parent && !shown[*parent]) shown[i] = false;
  }
  auto hidden = std::make_shared<std::vector<bool>>();
  for (const std::uint32_t node : node_of_) {
    hidden->push_back(!shown[node] || (!isolated_.empty() && !isolated[node]));
  }
  const bool any = std::ranges::find(*hidden, true) != hidden->end();
  hidden_instances_ = any ? std::move(hidden) : nullptr;
}

protocol::Result<void> apply_visibility(const protocol::EditDocument& document, NodeState& nodes) {
  if (const auto known = nodes.check(document.hidden, "edits.hidden"); !known) return known;
  if (const auto known = nodes.check(document.isolated, "edits.isolated"); !known) return known;
  if (!document.hidden.empty()) nodes.set_visible(document.hidden, false);
  nodes.isolate(document.isolated);
  return {};
}

}  // namespace heliograph::session
