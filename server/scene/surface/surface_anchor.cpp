#include "scene/surface/surface_anchor.hpp"

#include <algorithm>

#include "scene/animation/deform.hpp"

namespace heliograph::scene {
namespace {

const Deformation* deformation_of(const Scene& scene, std::uint32_t mesh) {
  const auto found = std::ranges::find(scene.deformations, mesh, &Deformation::mesh);
  return found == scene.deformations.end() ? nullptr : &*found;
}

}  // namespace

bool has_triangle(const Scene& scene, const SurfaceAnchor& anchor) {
  if (anchor.instance >= scene.instances.size()) return false;
  const Mesh& mesh = scene.meshes[scene.instances[anchor.instance].mesh];
  return anchor.triangle < mesh.indices.size() / 3;
}

SurfaceLocation locate(const Scene& scene, const Pose& pose, const SurfaceAnchor& anchor) {
  const Instance& instance = scene.instances[anchor.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Deformation* const deformation = deformation_of(scene, instance.mesh);
  std::array<glm::vec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = mesh.indices[3 * anchor.triangle + i];
    const glm::vec3 local = deformation ? deformed_position(scene, *deformation, pose, vertex)
                                        : mesh.vertices[vertex].position;
    corners[i] = glm::vec3(pose.worlds[instance.node] * glm::vec4(local, 1.0f));
  }
  const glm::vec3& weights = anchor.barycentrics;
  const glm::vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float length = glm::length(across);
  return {.position = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2],
          .normal = length > 0.0f ? across / length : glm::vec3(0.0f)};
}

std::vector<glm::vec3> world_positions(const Scene& scene, const Pose& pose,
                                       std::uint32_t instance_index) {
  const Instance& instance = scene.instances[instance_index];
  std::vector<shared::Vertex> deformed;
  const std::vector<shared::Vertex>* vertices = &scene.meshes[instance.mesh].vertices;
  if (const Deformation* const deformation = deformation_of(scene, instance.mesh)) {
    deformed.resize(vertices->size());
    deform(scene, *deformation, pose, deformed);
    vertices = &deformed;
  }
  std::vector<glm::vec3> positions;
  positions.reserve(vertices->size());
  for (const shared::Vertex& vertex : *vertices) {
    positions.push_back(glm::vec3(pose.worlds[instance.node] * glm::vec4(vertex.position, 1.0f)));
  }
  return positions;
}

}  // namespace heliograph::scene
