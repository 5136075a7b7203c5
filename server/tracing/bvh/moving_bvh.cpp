#include "tracing/bvh/moving_bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace heliograph::tracing {
namespace {

struct Boxes {
  scene::Bounds left;
  scene::Bounds right;
};

Boxes boxes_of(const shared::BvhNode& node) {
  const auto& [l, r, z] = std::tie(node.left_xy, node.right_xy, node.both_z);
  return {{{l.x, l.z, z.x}, {l.y, l.w, z.y}}, {{r.x, r.z, z.z}, {r.y, r.w, z.w}}};
}

void set_boxes(shared::BvhNode& node, const scene::Bounds& left, const scene::Bounds& right) {
  node.left_xy = {left.minimum.x, left.maximum.x, left.minimum.y, left.maximum.y};
  node.right_xy = {right.minimum.x, right.maximum.x, right.minimum.y, right.maximum.y};
  node.both_z = {left.minimum.z, left.maximum.z, right.minimum.z, right.maximum.z};
}

scene::Bounds box_of(std::span<const shared::BvhTriangle> triangles) {
  scene::Bounds box;
  for (const shared::BvhTriangle& triangle : triangles) {
    box.include(triangle.corner0);
    box.include(triangle.corner1);
    box.include(triangle.corner2);
  }
  return box;
}

void move_triangle(shared::BvhTriangle& triangle, std::span<const std::uint32_t> indices,
                   std::span<const shared::Vertex> vertices) {
  const std::size_t first = 3 * std::size_t(triangle.triangle & shared::bvh_number_mask);
  triangle.corner0 = vertices[indices[first]].position;
  triangle.corner1 = vertices[indices[first + 1]].position;
  triangle.corner2 = vertices[indices[first + 2]].position;
}

}  // namespace

MovingBvh::MovingBvh(RTCDevice device, std::shared_ptr<const Bvh> rest, const scene::Scene& scene)
    : device_(device), rest_(std::move(rest)), root_(rest_->root) {
  for (const scene::Instance& instance : scene.instances) {
    mesh_of_.push_back(instance.mesh);
    rest_worlds_.push_back(scene.nodes[instance.node].world);
  }
  for (const scene::Mesh& mesh : scene.meshes) bounds_.push_back(mesh.bounds);
  for (const scene::Deformation& deformation : scene.deformations) {
    const BvhMesh& mesh = rest_->meshes[deformation.mesh];
    if (mesh.root == shared::bvh_no_link) continue;
    Deforming& deforming = deforming_[deformation.mesh];
    deforming.indices = scene.meshes[deformation.mesh].indices;
    const auto first = rest_->records.begin() + static_cast<std::ptrdiff_t>(mesh.first_record);
    deforming.nodes.assign(first, first + static_cast<std::ptrdiff_t>(mesh.nodes));
    for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangles; ++i) {
      std::array<glm::vec4, shared::bvh_texels_per_triangle> texels;
      std::copy_n(&rest_->triangles[i * texels.size()], texels.size(), texels.begin());
      deforming.triangles.push_back(std::bit_cast<shared::BvhTriangle>(texels));
    }
  }
}

void MovingBvh::start(const Tables& tables) {
  std::copy_n(rest_->records.begin(), rest_->first_placed, tables.records.begin());
  if (!tables.triangles.empty()) std::ranges::copy(rest_->triangles, tables.triangles.begin());
  place(rest_worlds_, tables);
}

void MovingBvh::update(const Movement& movement, const Tables& tables) {
  for (const Movement::Mesh& mesh : movement.deformed) refit(mesh, tables);
  if (!movement.deformed.empty() || !movement.moved.empty()) place(movement.worlds, tables);
}

// Children follow their parent, so that one backward pass visits them first.
void MovingBvh::refit(const Movement::Mesh& movement, const Tables& tables) {
  bounds_[movement.mesh] = movement.bounds;
  const auto found = deforming_.find(movement.mesh);
  if (found == deforming_.end()) return;
  auto& [indices, triangles, nodes] = found->second;
  const BvhMesh& mesh = rest_->meshes[movement.mesh];
  for (auto& triangle : triangles) move_triangle(triangle, indices, movement.vertices);
  const auto box_below = [&](std::uint32_t link) {
    if (link & shared::bvh_leaf_bit) {
      const std::size_t first = (link & shared::bvh_leaf_first_mask) - mesh.first_triangle;
      const std::size_t count =
          ((link >> shared::bvh_leaf_count_shift) & shared::bvh_leaf_count_mask) + 1;
      return box_of(std::span(triangles).subspan(first, count));
    }
    Boxes boxes = boxes_of(nodes[(link & shared::bvh_number_mask) - mesh.first_record]);
    boxes.left.include(boxes.right);
    return boxes.left;
  };
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    set_boxes(*node, box_below(node->left), box_below(node->right));
  }
  std::ranges::copy(nodes, tables.records.begin() + static_cast<std::ptrdiff_t>(mesh.first_record));
  const auto bytes = std::as_bytes(std::span(triangles));
  std::ranges::copy(
      bytes, std::as_writable_bytes(tables.triangles).begin() +
                 static_cast<std::ptrdiff_t>(mesh.first_triangle * sizeof(shared::BvhTriangle)));
}

void MovingBvh::place(std::span<const glm::mat4> worlds, const Tables& tables) {
  const BvhTopLevel top = build_top_level(device_, *rest_, mesh_of_, worlds, bounds_);
  std::ranges::copy(top.records,
                    tables.records.begin() + static_cast<std::ptrdiff_t>(rest_->first_placed));
  root_ = top.root;
}

}  // namespace heliograph::tracing
