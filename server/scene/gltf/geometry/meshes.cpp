#include "scene/gltf/geometry/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/packing.hpp>
#include <numeric>

#include "scene/gltf/geometry/tangents.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using shared::Vertex;

// Corners in drawing order -> triangles of consistent winding (glTF 3.7.2.1).
std::vector<std::uint32_t> to_triangles(Primitive::Mode mode, std::vector<std::uint32_t> corners) {
  const std::size_t count = corners.size();
  if (mode == Primitive::Mode::triangles) {
    corners.resize(count / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> triangles;
  triangles.reserve((count - 2) * 3);
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (mode == Primitive::Mode::strip) {
      triangles.insert(triangles.end(),
                       {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    } else {
      triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
  }
  return triangles;
}

std::vector<std::uint32_t> read_triangles(const Primitive& primitive,
                                          std::span<const Accessor> accessors) {
  const std::uint32_t vertex_count = accessors[primitive.position].count;
  std::vector<std::uint32_t> corners;
  if (primitive.indices) {
    corners = read_vertex_indices(accessors[*primitive.indices], vertex_count);
  } else {
    corners.resize(vertex_count);
    std::iota(corners.begin(), corners.end(), 0u);
  }
  return to_triangles(primitive.mode, std::move(corners));
}

void store_color(Vertex& vertex, const glm::vec4& color) {
  vertex.color_rg = glm::packUnorm2x16({color.x, color.y});
  vertex.color_ba = glm::packUnorm2x16({color.z, color.w});
}

std::vector<Vertex> read_vertices(const Primitive& primitive, std::span<const Accessor> accessors,
                                  const std::stop_token& stop) {
  const std::vector<glm::vec3> positions = read_vectors<3>(accessors[primitive.position]);
  std::vector<Vertex> vertices(positions.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].position = positions[i];
    store_color(vertices[i], glm::vec4(1.0f));
  }
  const auto fill = [&]<int components>(std::optional<std::uint32_t> accessor, auto store) {
    if (!accessor) return;
    throw_if_cancelled(stop);
    const auto values = read_vectors<components>(accessors[*accessor]);
    for (std::size_t i = 0; i < vertices.size(); ++i) store(vertices[i], values[i]);
  };
  fill.operator()<3>(primitive.normal, [](Vertex& v, const glm::vec3& value) { v.normal = value; });
  fill.operator()<4>(primitive.tangent,
                     [](Vertex& v, const glm::vec4& value) { v.tangent = value; });
  fill.operator()<2>(primitive.uv[0], [](Vertex& v, const glm::vec2& value) { v.uv0 = value; });
  fill.operator()<2>(primitive.uv[1], [](Vertex& v, const glm::vec2& value) { v.uv1 = value; });
  if (primitive.color) {
    const bool has_alpha = accessors[*primitive.color].element == ElementType::vec4;
    fill.operator()<4>(primitive.color, [&](Vertex& v, const glm::vec4& value) {
      store_color(v, has_alpha ? value : glm::vec4(glm::vec3(value), 1.0f));
    });
  }
  return vertices;
}

glm::vec3 face_normal(const Vertex& a, const Vertex& b, const Vertex& c) {
  // In double: the float product of tiny edges underflows, that of huge ones overflows.
  const glm::dvec3 first = glm::dvec3(b.position) - glm::dvec3(a.position);
  const glm::dvec3 second = glm::dvec3(c.position) - glm::dvec3(a.position);
  const glm::dvec3 normal = glm::cross(first, second);
  const double length = glm::length(normal);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(normal / length)
                                               : glm::vec3(0.0f, 0.0f, 1.0f);
}

// Flat shading: triangles share no vertices.
void make_flat(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
  std::vector<Vertex> flat;
  flat.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3 normal =
        face_normal(vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      flat.push_back(vertices[indices[i + corner]]);
      flat.back().normal = normal;
    }
  }
  vertices = std::move(flat);
  std::iota(indices.begin(), indices.end(), 0u);
}

// Normals in files have any length; zero normals are replaced by the face normal.
void normalize_normals(std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
  bool all_valid = true;
  for (Vertex& vertex : vertices) {
    const float length = glm::length(vertex.normal);
    const bool valid = length > 1e-12f && std::isfinite(length);
    vertex.normal = valid ? vertex.normal / length : glm::vec3(0.0f);
    all_valid = all_valid && valid;
  }
  if (all_valid) return;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    Vertex& vertex = vertices[indices[i]];
    if (vertex.normal != glm::vec3(0.0f)) continue;
    const std::size_t first = i / 3 * 3;
    vertex.normal = face_normal(vertices[indices[first]], vertices[indices[first + 1]],
                                vertices[indices[first + 2]]);
  }
  for (Vertex& vertex : vertices) {
    if (vertex.normal == glm::vec3(0.0f)) vertex.normal = {0.0f, 0.0f, 1.0f};
  }
}

void orthonormalize_tangents(std::vector<Vertex>& vertices) {
  for (Vertex& vertex : vertices) {
    const glm::vec3 given(vertex.tangent);
    const glm::vec3 tangent = given - vertex.normal * glm::dot(vertex.normal, given);
    const float length = glm::length(tangent);
    const bool valid = length > 1e-6f && std::isfinite(length);
    vertex.tangent = glm::vec4(valid ? tangent / length : perpendicular_to(vertex.normal),
                               vertex.tangent.w < 0.0f ? -1.0f : 1.0f);
  }
}

/// Vertices were duplicated, but corners kept their order.
std::vector<std::uint32_t> trace_back(const Mesh& mesh, std::span<const std::uint32_t> corners) {
  std::vector<std::uint32_t> sources(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < corners.size(); ++i) sources[mesh.indices[i]] = corners[i];
  return sources;
}

}  // namespace

BuiltMesh build_mesh(const Primitive& primitive, std::span<const Accessor> accessors,
                     std::uint32_t material, std::span<const shared::Material> materials,
                     std::span<const MaterialLayers> layers, const std::stop_token& stop) {
  BuiltMesh built;
  Mesh& mesh = built.mesh;
  mesh.name = primitive.name;
  mesh.material = material;
  mesh.indices = read_triangles(primitive, accessors);
  throw_if_cancelled(stop);
  mesh.vertices = read_vertices(primitive, accessors, stop);
  throw_if_cancelled(stop);
  const std::vector<std::uint32_t> corners =
      primitive.deforms() ? mesh.indices : std::vector<std::uint32_t>();
  if (primitive.normal) {
    normalize_normals(mesh.vertices, mesh.indices);
  } else {
    make_flat(mesh.vertices, mesh.indices);
  }
  throw_if_cancelled(stop);
  // Tangents without normals are ignored (glTF 3.7.2.1).
  const bool has_tangents = primitive.tangent && primitive.normal;
  const shared::TextureSlot& normal_map = materials[material].normal_texture;
  const bool bumpy = normal_map.texture != shared::no_texture;
  if (has_tangents || !(bumpy || layers[material].anisotropy > 0.0f)) {
    orthonormalize_tangents(mesh.vertices);
  } else {
    const shared::TextureSlot& map = bumpy ? normal_map : layers[material].anisotropy_texture;
    generate_tangents(mesh.vertices, mesh.indices, map, stop);
  }
  for (const std::uint32_t index : mesh.indices) mesh.bounds.include(mesh.vertices[index].position);
  if (primitive.deforms()) built.sources = trace_back(mesh, corners);
  return built;
}

}  // namespace heliograph::scene
