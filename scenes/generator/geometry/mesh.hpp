#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace heliograph::scenes {

/// One corner of a triangle. Positions in metres, +Y up. `uv` is in metres of surface until
/// scale_uv() turns it into texture repeats; its origin is the top left corner of the image.
struct Vertex {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};
  glm::vec2 uv{0.0f};
};

/// Indexed triangles, counter-clockwise seen from the side the normals point to.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  std::size_t triangle_count() const { return indices.size() / 3; }

  void append(const Mesh& other, const glm::mat4& placement = glm::mat4(1.0f));

  /// Adds a triangle, turned round where its winding disagrees with the normals of its corners,
  /// and left out where it has no area.
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
};

void scale_uv(Mesh& mesh, glm::vec2 repeats_per_metre);

/// Fills Vertex::tangent: along +u, orthogonal to the normal, with the handedness glTF wants
/// (bitangent = w * cross(normal, tangent) points to the top of the image, that is along -v).
/// Triangles are weighted by their corner angle, as MikkTSpace does.
void compute_tangents(Mesh& mesh);

}  // namespace heliograph::scenes
