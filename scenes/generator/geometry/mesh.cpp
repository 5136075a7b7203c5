#include "scenes/generator/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::scenes {
namespace {

constexpr float smallest_double_area = 1e-9f;

glm::vec3 any_orthogonal(glm::vec3 normal) {
  const glm::vec3 helper = std::abs(normal.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  return glm::normalize(glm::cross(helper, normal));
}

float corner_angle(glm::vec3 corner, glm::vec3 left, glm::vec3 right) {
  const glm::vec3 a = left - corner;
  const glm::vec3 b = right - corner;
  const float length = glm::length(a) * glm::length(b);
  if (length <= 0.0f) return 0.0f;
  return std::acos(std::clamp(glm::dot(a, b) / length, -1.0f, 1.0f));
}

struct SurfaceGradient {
  glm::vec3 along_u{0.0f};
  glm::vec3 along_v{0.0f};
};

// Unit directions in which u and v grow over a triangle; zero where its uv has no area.
SurfaceGradient gradient(const Vertex& a, const Vertex& b, const Vertex& c) {
  const glm::vec3 edge_b = b.position - a.position;
  const glm::vec3 edge_c = c.position - a.position;
  const glm::vec2 uv_b = b.uv - a.uv;
  const glm::vec2 uv_c = c.uv - a.uv;
  const float determinant = uv_b.x * uv_c.y - uv_c.x * uv_b.y;
  if (std::abs(determinant) < 1e-12f) return {};
  const float side = determinant > 0.0f ? 1.0f : -1.0f;
  const glm::vec3 along_u = (edge_b * uv_c.y - edge_c * uv_b.y) * side;
  const glm::vec3 along_v = (edge_c * uv_b.x - edge_b * uv_c.x) * side;
  const float length_u = glm::length(along_u);
  const float length_v = glm::length(along_v);
  if (length_u < 1e-12f || length_v < 1e-12f) return {};
  return {along_u / length_u, along_v / length_v};
}

}  // namespace

void Mesh::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const glm::vec3 pa = vertices[a].position;
  const glm::vec3 facing = glm::cross(vertices[b].position - pa, vertices[c].position - pa);
  if (glm::length(facing) < smallest_double_area) return;
  const glm::vec3 wanted = vertices[a].normal + vertices[b].normal + vertices[c].normal;
  if (glm::dot(facing, wanted) < 0.0f) std::swap(b, c);
  indices.insert(indices.end(), {a, b, c});
}

void Mesh::append(const Mesh& other, const glm::mat4& placement) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const glm::mat3 linear(placement);
  const glm::mat3 normal_matrix = glm::transpose(glm::inverse(linear));
  const bool mirrored = glm::determinant(linear) < 0.0f;
  vertices.reserve(vertices.size() + other.vertices.size());
  for (Vertex vertex : other.vertices) {
    vertex.position = glm::vec3(placement * glm::vec4(vertex.position, 1.0f));
    vertex.normal = glm::normalize(normal_matrix * vertex.normal);
    vertices.push_back(vertex);
  }
  indices.reserve(indices.size() + other.indices.size());
  for (std::size_t i = 0; i + 2 < other.indices.size(); i += 3) {
    indices.push_back(first + other.indices[i]);
    indices.push_back(first + other.indices[i + (mirrored ? 2 : 1)]);
    indices.push_back(first + other.indices[i + (mirrored ? 1 : 2)]);
  }
}

void scale_uv(Mesh& mesh, glm::vec2 repeats_per_metre) {
  for (Vertex& vertex : mesh.vertices) vertex.uv *= repeats_per_metre;
}

void compute_tangents(Mesh& mesh) {
  std::vector<SurfaceGradient> sums(mesh.vertices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* corner = &mesh.indices[i];
    const SurfaceGradient face =
        gradient(mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]);
    for (int k = 0; k < 3; ++k) {
      const float weight = corner_angle(mesh.vertices[corner[k]].position,
                                        mesh.vertices[corner[(k + 1) % 3]].position,
                                        mesh.vertices[corner[(k + 2) % 3]].position);
      sums[corner[k]].along_u += face.along_u * weight;
      sums[corner[k]].along_v += face.along_v * weight;
    }
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vertex& vertex = mesh.vertices[i];
    const glm::vec3 along_u = sums[i].along_u;
    const glm::vec3 in_plane = along_u - vertex.normal * glm::dot(vertex.normal, along_u);
    const float length = glm::length(in_plane);
    const glm::vec3 tangent = length > 1e-6f ? in_plane / length : any_orthogonal(vertex.normal);
    const glm::vec3 to_image_top = -sums[i].along_v;
    const bool right_handed = glm::dot(glm::cross(vertex.normal, tangent), to_image_top) >= 0.0f;
    vertex.tangent = glm::vec4(tangent, right_handed ? 1.0f : -1.0f);
  }
}

}  // namespace heliograph::scenes
