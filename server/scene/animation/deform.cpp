#include "scene/animation/deform.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace heliograph::scene {
namespace {

struct ActiveTarget {
  const MorphTarget& target;
  float weight;
};

std::vector<ActiveTarget> active_targets(const Shape& shape, const std::vector<float>& weights) {
  std::vector<ActiveTarget> active;
  for (std::size_t i = 0; i < std::min(shape.targets.size(), weights.size()); ++i) {
    if (weights[i] != 0.0f) active.push_back({shape.targets[i], weights[i]});
  }
  return active;
}

std::vector<glm::mat4> joint_matrices(const Skin& skin, const Pose& pose) {
  std::vector<glm::mat4> matrices;
  matrices.reserve(skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    matrices.push_back(pose.worlds[skin.joints[i]] * skin.inverse_bind[i]);
  }
  return matrices;
}

inline glm::vec3 unit_or(const glm::vec3& vector, const glm::vec3& fallback) {
  const float squared = glm::dot(vector, vector);
  if (squared > 1e-30f && squared < 1e30f) return vector * (1.0f / std::sqrt(squared));
  const glm::dvec3 wide(vector);  // its square neither underflows nor overflows
  const double length = glm::length(wide);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(wide / length) : fallback;
}

void add(glm::vec3& sum, const std::vector<glm::vec3>& differences, std::size_t vertex,
         float weight) {
  if (!differences.empty()) sum += weight * differences[vertex];
}

shared::Vertex morphed(const shared::Vertex& base, std::size_t index,
                       std::span<const ActiveTarget> targets) {
  if (targets.empty()) return base;
  shared::Vertex vertex = base;
  glm::vec3 tangent(base.tangent);
  for (const auto& [target, weight] : targets) {
    add(vertex.position, target.positions, index, weight);
    add(vertex.normal, target.normals, index, weight);
    add(tangent, target.tangents, index, weight);
  }
  vertex.normal = unit_or(vertex.normal, base.normal);
  vertex.tangent = glm::vec4(unit_or(tangent, glm::vec3(base.tangent)), base.tangent.w);
  return vertex;
}

/// The cofactor matrix: the inverse transpose up to scale, without its division.
glm::mat3 cofactors(const glm::mat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

void skin(shared::Vertex& vertex, std::span<const JointWeight> influences,
          std::span<const glm::mat4> joints) {
  glm::mat4 blended(0.0f);
  for (const auto& [joint, weight] : influences) {
    if (weight != 0.0f) blended += weight * joints[joint];
  }
  const glm::mat3 linear(blended);
  const glm::mat3 turned = cofactors(linear);
  const float determinant = glm::dot(linear[0], turned[0]);
  const float mirror = determinant < 0.0f ? -1.0f : 1.0f;
  vertex.position = glm::vec3(blended * glm::vec4(vertex.position, 1.0f));
  vertex.normal = unit_or(mirror * (turned * vertex.normal), vertex.normal);
  const glm::vec3 tangent(vertex.tangent);
  vertex.tangent = glm::vec4(unit_or(linear * tangent, tangent), mirror * vertex.tangent.w);
}

void make_flat_normals(std::span<shared::Vertex> triangle) {
  const glm::vec3 across = glm::cross(triangle[1].position - triangle[0].position,
                                      triangle[2].position - triangle[0].position);
  for (shared::Vertex& vertex : triangle) vertex.normal = unit_or(across, vertex.normal);
}

}  // namespace

bool shape_differs(const Scene& scene, const Deformation& deformation, const Pose& a,
                   const Pose& b) {
  if (a.weights[deformation.node] != b.weights[deformation.node]) return true;
  if (!deformation.skin) return false;
  return std::ranges::any_of(scene.skins[*deformation.skin].joints, [&](std::uint32_t joint) {
    return a.worlds[joint] != b.worlds[joint];
  });
}

Bounds deform(const Scene& scene, const Deformation& deformation, const Pose& pose,
              std::span<shared::Vertex> vertices) {
  const Shape& shape = scene.shapes[deformation.shape];
  const auto targets = active_targets(shape, pose.weights[deformation.node]);
  std::vector<glm::mat4> joints;
  if (deformation.skin) joints = joint_matrices(scene.skins[*deformation.skin], pose);

  const auto deform_range = [&](const tbb::blocked_range<std::size_t>& triples, Bounds bounds) {
    const std::size_t end = std::min(3 * triples.end(), vertices.size());
    for (std::size_t i = 3 * triples.begin(); i < end; ++i) {
      vertices[i] = morphed(shape.vertices[i], i, targets);
      if (!joints.empty()) {
        const std::size_t count = shape.joints_per_vertex;
        skin(vertices[i], std::span(shape.influences).subspan(i * count, count), joints);
      }
      bounds.include(vertices[i].position);
    }
    if (!shape.flat) return bounds;
    for (std::size_t i = 3 * triples.begin(); i + 2 < end; i += 3) {
      make_flat_normals(vertices.subspan(i, 3));
    }
    return bounds;
  };
  const auto both = [](Bounds a, const Bounds& b) {
    a.include(b);
    return a;
  };
  const tbb::blocked_range<std::size_t> all(0, (vertices.size() + 2) / 3, 512);
  return tbb::parallel_reduce(all, Bounds{}, deform_range, both);
}

glm::vec3 deformed_position(const Scene& scene, const Deformation& deformation, const Pose& pose,
                            std::uint32_t vertex) {
  const Shape& shape = scene.shapes[deformation.shape];
  const auto targets = active_targets(shape, pose.weights[deformation.node]);
  shared::Vertex placed = morphed(shape.vertices[vertex], vertex, targets);
  if (deformation.skin) {
    const auto joints = joint_matrices(scene.skins[*deformation.skin], pose);
    const std::size_t count = shape.joints_per_vertex;
    skin(placed, std::span(shape.influences).subspan(vertex * count, count), joints);
  }
  return placed.position;
}

}  // namespace heliograph::scene
