#include "scenes/generator/geometry/icosphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <utility>

#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

using Face = std::array<int, 3>;

struct DirectionMesh {
  std::vector<glm::vec3> directions;
  std::vector<Face> faces;
};

DirectionMesh icosahedron() {
  const float t = 0.5f + 0.5f * std::sqrt(5.0f);
  DirectionMesh mesh;
  mesh.directions = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                     {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  for (glm::vec3& direction : mesh.directions) direction = glm::normalize(direction);
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

DirectionMesh subdivided(const DirectionMesh& coarse) {
  DirectionMesh fine{coarse.directions, {}};
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [known, added] =
        middles.try_emplace({std::min(a, b), std::max(a, b)}, int(fine.directions.size()));
    if (added) {
      fine.directions.push_back(
          glm::normalize(fine.directions[std::size_t(a)] + fine.directions[std::size_t(b)]));
    }
    return known->second;
  };
  for (const Face& face : coarse.faces) {
    const int ab = middle(face[0], face[1]);
    const int bc = middle(face[1], face[2]);
    const int ca = middle(face[2], face[0]);
    fine.faces.insert(fine.faces.end(),
                      {{face[0], ab, ca}, {face[1], bc, ab}, {face[2], ca, bc}, {ab, bc, ca}});
  }
  return fine;
}

DirectionMesh unit_icosphere(int level) {
  DirectionMesh mesh = icosahedron();
  for (int i = 0; i < level; ++i) mesh = subdivided(mesh);
  return mesh;
}

bool is_pole(glm::vec3 direction) {
  return std::abs(direction.y) > 0.999999f;
}

// Longitudes of a face in [0, 1.5): those past the seam go on above 1, and a pole takes the middle
// of the two others, so that no triangle runs the long way round the texture.
std::array<float, 3> longitudes(const std::array<glm::vec3, 3>& corners) {
  std::array<float, 3> u;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = 0.5f + std::atan2(-corners[k].z, corners[k].x) / (2.0f * pi);
  }
  float highest = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_pole(corners[k])) highest = std::max(highest, u[k]);
  }
  for (float& value : u) value += highest - value > 0.5f ? 1.0f : 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_pole(corners[k])) u[k] = 0.5f * (u[(k + 1) % 3] + u[(k + 2) % 3]);
  }
  return u;
}

}  // namespace

Mesh icosphere(int level, glm::vec2 uv_extent,
               const std::function<SurfacePoint(glm::vec3)>& surface) {
  const DirectionMesh sphere = unit_icosphere(level);
  Mesh mesh;
  std::map<std::pair<int, float>, std::uint32_t> vertices;
  for (const Face& face : sphere.faces) {
    std::array<glm::vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = sphere.directions[std::size_t(face[k])];
    const std::array<float, 3> u = longitudes(corners);
    std::array<std::uint32_t, 3> indices;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [known, added] =
          vertices.try_emplace({face[k], u[k]}, std::uint32_t(mesh.vertices.size()));
      indices[k] = known->second;
      if (!added) continue;
      const SurfacePoint point = surface(corners[k]);
      const float v = std::acos(std::clamp(corners[k].y, -1.0f, 1.0f)) / pi;
      mesh.vertices.push_back({point.position, point.normal, {}, glm::vec2(u[k], v) * uv_extent});
    }
    mesh.add_triangle(indices[0], indices[1], indices[2]);
  }
  return mesh;
}

Mesh icosphere(float radius, int level) {
  return icosphere(level, glm::vec2(2.0f * pi, pi) * radius, [radius](glm::vec3 direction) {
    return SurfacePoint{radius * direction, direction, {}};
  });
}

Mesh faceted_icosphere(float radius, int level) {
  const DirectionMesh sphere = unit_icosphere(level);
  Mesh mesh;
  for (const Face& face : sphere.faces) {
    std::array<glm::vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = radius * sphere.directions[std::size_t(face[k])];
    const glm::vec3 normal = glm::normalize(p[0] + p[1] + p[2]);
    const glm::vec3 flat = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    const glm::vec3 outward = glm::dot(flat, normal) > 0.0f ? flat : -flat;
    const glm::vec3 along = glm::normalize(p[1] - p[0]);
    const glm::vec3 across = glm::cross(outward, along);
    const auto first = std::uint32_t(mesh.vertices.size());
    for (const glm::vec3 corner : p) {
      const glm::vec2 uv(glm::dot(corner - p[0], along), -glm::dot(corner - p[0], across));
      mesh.vertices.push_back({corner, outward, {}, uv});
    }
    mesh.add_triangle(first, first + 1, first + 2);
  }
  return mesh;
}

}  // namespace heliograph::scenes
