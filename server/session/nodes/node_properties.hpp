#pragma once

#include <cstdint>
#include <span>

#include "scene/animation/pose.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {

/// The part of the scene's nodes that is asked for; `rev` is left to the caller.
protocol::NodeList list_nodes(const scene::Scene& scene, const NodeState& state,
                              const protocol::NodesList& request);
/// Of checked ids.
protocol::NodeProperties node_properties(const scene::Scene& scene, const NodeState& state,
                                         std::span<const std::uint32_t> nodes);
/// Around the meshes of these nodes and of all below them in a pose of the scene, world space.
scene::Bounds node_bounds(const scene::Scene& scene, const scene::Pose& pose,
                          const NodeState& state, std::span<const std::uint32_t> nodes);

}  // namespace heliograph::session
