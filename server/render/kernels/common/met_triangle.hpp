#pragma once

#include "render/resources/host_tables.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render::kernels {

/// A triangle that a ray has met, as load_triangle() of shaders/lib/scene/hit_surface.glsl has it.
struct MetTriangle {
  const shared::Vertex& a;
  const shared::Vertex& b;
  const shared::Vertex& c;
  glm::vec3 weights;
  glm::mat3 world;   // mesh -> world, of directions
  float handedness;  // -1 where the matrix changes it, or 1
  std::uint32_t material;

  glm::vec3 position() const {  // mesh space
    return a.position * weights.x + b.position * weights.y + c.position * weights.z;
  }
  glm::vec2 uv() const { return a.uv0 * weights.x + b.uv0 * weights.y + c.uv0 * weights.z; }
  /// Its front face's normal, world space, of any length.
  glm::vec3 front() const {
    return glm::cross(world * (b.position - a.position), world * (c.position - a.position)) *
           handedness;
  }
};

inline MetTriangle met_triangle(const SceneView& scene, const shared::Hit& hit) {
  const shared::Instance& instance = scene.instances[hit.instance];
  const shared::Mesh& mesh = scene.meshes[instance.mesh];
  const std::uint32_t* const corners = scene.indices + mesh.first_index + 3 * hit.triangle;
  const shared::Vertex* const vertices = scene.vertices + mesh.first_vertex;
  return {.a = vertices[corners[0]],
          .b = vertices[corners[1]],
          .c = vertices[corners[2]],
          .weights = glm::vec3(1.0f - hit.u - hit.v, hit.u, hit.v),
          .world = glm::mat3(instance.world),
          .handedness = (instance.flags & shared::instance_flipped) != 0 ? -1.0f : 1.0f,
          .material = mesh.material};
}

}  // namespace heliograph::render::kernels
