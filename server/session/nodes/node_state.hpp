#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/node_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

namespace heliograph::session {

/// The node that an instance belongs to: of a skinned mesh, whose instance lies at the origin, the
/// one that has the mesh.
std::vector<std::uint32_t> nodes_of_instances(const scene::Scene& scene);
/// Its name, otherwise that of its mesh; may be empty.
std::vector<std::string> node_names(const scene::Scene& scene);

/// Which nodes of a scene one session shows, and which are selected. A refused request changes
/// nothing. Not thread safe.
class NodeState {
 public:
  NodeState() = default;
  explicit NodeState(std::shared_ptr<const scene::Scene> scene);

  /// Whether every id is one of the scene's; `path` names the list.
  protocol::Result<void> check(std::span<const std::uint32_t> nodes, const char* path) const;

  /// Of checked ids. @return whether anything changed
  bool set_visible(std::span<const std::uint32_t> nodes, bool visible);
  bool isolate(std::span<const std::uint32_t> nodes);
  bool select(std::span<const std::uint32_t> nodes);

  bool is_visible(std::uint32_t node) const { return visible_[node]; }
  std::vector<std::uint32_t> hidden() const;
  const std::vector<std::uint32_t>& isolated() const { return isolated_; }
  const std::vector<std::uint32_t>& selected() const { return selected_; }

  /// By node: whether it is one of these or below one of them.
  std::vector<bool> within(std::span<const std::uint32_t> nodes) const;

  /// By instance of the scene, whether it is hidden; null: none is. A change makes a new list.
  const std::shared_ptr<const std::vector<bool>>& hidden_instances() const {
    return hidden_instances_;
  }
  /// Null: none is.
  const std::shared_ptr<const std::vector<std::uint32_t>>& selected_instances() const {
    return selected_instances_;
  }

 private:
  void update_hidden();

  std::shared_ptr<const scene::Scene> scene_;
  std::vector<std::uint32_t> node_of_;  // by instance
  std::vector<bool> visible_;           // by node
  std::vector<std::uint32_t> isolated_;
  std::vector<std::uint32_t> selected_;
  std::shared_ptr<const std::vector<bool>> hidden_instances_;
  std::shared_ptr<const std::vector<std::uint32_t>> selected_instances_;
};

/// Hides and isolates in `nodes`, where all are visible, what a document says; errors name its
/// member.
protocol::Result<void> apply_visibility(const protocol::EditDocument& document, NodeState& nodes);

}  // namespace heliograph::session
