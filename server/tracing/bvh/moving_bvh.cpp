#include "tracing/bvh/moving_bvh.hpp"

#include <algorithm>

namespace heliograph::tracing {

MovingBvh::MovingBvh(RTCDevice device, std::shared_ptr<const Bvh> rest, const scene::Scene& scene)
    : device_(device), rest_(std::move(rest)), root_(rest_->root) {
  for (const scene::Instance& instance : scene.instances) {
    mesh_of_.push_back(instance.mesh);
    rest_worlds_.push_back(scene.nodes[instance.node].world);
  }
  for (const scene::Mesh& mesh : scene.meshes) bounds_.push_back(mesh.bounds);
}

void MovingBvh::start(const Tables& tables) {
  std::copy_n(rest_->records.begin(), rest_->first_placed, tables.records.begin());
  if (!tables.triangles.empty()) std::ranges::copy(rest_->triangles, tables.triangles.begin());
  place(rest_worlds_, tables);
}

void MovingBvh::update(const Movement& movement, const Tables& tables) {
  for (const Movement::Mesh& mesh : movement.deformed) bounds_[mesh.mesh] = mesh.bounds;
  if (!movement.deformed.empty() || !movement.moved.empty()) place(movement.worlds, tables);
}

void MovingBvh::place(std::span<const glm::mat4> worlds, const Tables& tables) {
  const BvhTopLevel top = build_top_level(device_, *rest_, mesh_of_, worlds, bounds_);
  std::ranges::copy(top.records,
                    tables.records.begin() + static_cast<std::ptrdiff_t>(rest_->first_placed));
  root_ = top.root;
  upper_nodes_ = top.nodes;
}

}  // namespace heliograph::tracing
