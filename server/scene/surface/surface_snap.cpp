#include "scene/surface/surface_snap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace heliograph::scene {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

/// A hit farther from the expected distance than this part of it is another surface's.
constexpr double hit_tolerance = 0.02;
/// Two triangles whose normals differ by less (about half a degree) are one face.
constexpr double flat_cosine = 0.99996;

Triangle triangle_at(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                     std::size_t triangle) {
  const auto corner = [&](std::size_t i) {
    return glm::dvec3(positions[indices[3 * triangle + i]]);
  };
  return {corner(0), corner(1), corner(2)};
}

struct RayHit {
  double distance;
  glm::dvec3 barycentrics;
};

/// Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
std::optional<RayHit> intersect(const Triangle& triangle, const glm::dvec3& origin,
                                const glm::dvec3& direction) {
  const glm::dvec3 first = triangle[1] - triangle[0], second = triangle[2] - triangle[0];
  const glm::dvec3 across = glm::cross(direction, second);
  const double determinant = glm::dot(first, across);
  if (determinant == 0.0) return std::nullopt;
  const glm::dvec3 offset = origin - triangle[0];
  const double u = glm::dot(offset, across) / determinant;
  const glm::dvec3 turned = glm::cross(offset, first);
  const double v = glm::dot(direction, turned) / determinant;
  if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) return std::nullopt;
  return RayHit{glm::dot(second, turned) / determinant, {1.0 - u - v, u, v}};
}

/// The nearest point of the segment from a to b, as its fraction.
double nearest_fraction(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& point) {
  const glm::dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  return squared > 0.0 ? std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0.0;
}

glm::dvec3 at(const Triangle& triangle, const glm::dvec3& weights) {
  return weights.x * triangle[0] + weights.y * triangle[1] + weights.z * triangle[2];
}

/// Weights of the nearest point of an edge, which begins at vertex `edge`.
glm::dvec3 nearest_on_edge(const Triangle& triangle, int edge, const glm::dvec3& point) {
  const int next = (edge + 1) % 3;
  const double t = nearest_fraction(triangle[static_cast<std::size_t>(edge)],
                                    triangle[static_cast<std::size_t>(next)], point);
  glm::dvec3 weights(0.0);
  weights[edge] = 1.0 - t;
  weights[next] = t;
  return weights;
}

double distance_to(const Triangle& triangle, const glm::dvec3& weights, const glm::dvec3& point) {
  return glm::length(at(triangle, weights) - point);
}

/// Weights of the triangle's point nearest to `point`.
glm::dvec3 nearest_on_triangle(const Triangle& triangle, const glm::dvec3& point) {
  const glm::dvec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  if (const double squared = glm::dot(normal, normal); squared > 0.0) {
    if (const auto inside = intersect(triangle, point, normal / std::sqrt(squared))) {
      return inside->barycentrics;
    }
  }
  glm::dvec3 nearest = nearest_on_edge(triangle, 0, point);
  for (int edge = 1; edge < 3; ++edge) {
    const glm::dvec3 weights = nearest_on_edge(triangle, edge, point);
    if (distance_to(triangle, weights, point) < distance_to(triangle, nearest, point)) {
      nearest = weights;
    }
  }
  return nearest;
}

struct Found {
  std::size_t triangle;
  glm::dvec3 weights;
  glm::dvec3 position;
};

std::optional<Found> hit_of(std::span<const glm::vec3> positions,
                            std::span<const std::uint32_t> indices, const SnapQuery& query) {
  const glm::dvec3 origin(query.origin), direction(query.direction);
  const double expected = query.distance;
  std::optional<Found> found;
  double least = hit_tolerance * std::abs(expected);
  for (std::size_t i = 0; i < indices.size() / 3; ++i) {
    const Triangle triangle = triangle_at(positions, indices, i);
    const auto hit = intersect(triangle, origin, direction);
    if (!hit || std::abs(hit->distance - expected) > least) continue;
    least = std::abs(hit->distance - expected);
    found = {i, hit->barycentrics, at(triangle, hit->barycentrics)};
  }
  if (found) return found;
  const glm::dvec3 point = origin + expected * direction;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < indices.size() / 3; ++i) {
    const Triangle triangle = triangle_at(positions, indices, i);
    const glm::dvec3 weights = nearest_on_triangle(triangle, point);
    const double distance = distance_to(triangle, weights, point);
    if (!(distance < nearest)) continue;
    nearest = distance;
    found = {i, weights, at(triangle, weights)};
  }
  return found;
}

/// Triangles whose bounding boxes are within `radius` of a point.
std::vector<std::size_t> triangles_near(std::span<const glm::vec3> positions,
                                        std::span<const std::uint32_t> indices,
                                        const glm::dvec3& point, double radius) {
  const glm::vec3 low(point - radius), high(point + radius);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < indices.size() / 3; ++i) {
    const glm::vec3& a = positions[indices[3 * i]];
    const glm::vec3& b = positions[indices[3 * i + 1]];
    const glm::vec3& c = positions[indices[3 * i + 2]];
    const glm::vec3 least = glm::min(a, glm::min(b, c)), most = glm::max(a, glm::max(b, c));
    if (glm::all(glm::lessThanEqual(least, high)) && glm::all(glm::greaterThanEqual(most, low))) {
      near.push_back(i);
    }
  }
  return near;
}

std::optional<Found> nearest_vertex(std::span<const glm::vec3> positions,
                                    std::span<const std::uint32_t> indices,
                                    std::span<const std::size_t> near, const glm::dvec3& point,
                                    double radius) {
  std::optional<Found> found;
  for (const std::size_t i : near) {
    const Triangle triangle = triangle_at(positions, indices, i);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3& position = triangle[static_cast<std::size_t>(corner)];
      const double distance = glm::length(position - point);
      if (distance > radius || (found && distance >= glm::length(found->position - point))) {
        continue;
      }
      glm::dvec3 weights(0.0);
      weights[corner] = 1.0;
      found = {i, weights, position};
    }
  }
  return found;
}

/// An edge by its ends, in the order of their coordinates: vertices at one place are one.
using EdgeKey = std::array<float, 6>;

EdgeKey edge_key(glm::vec3 a, glm::vec3 b) {
  if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
  return {a.x, a.y, a.z, b.x, b.y, b.z};
}

glm::dvec3 normal_of(const Triangle& triangle) {
  const glm::dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double length = glm::length(across);
  return length > 0.0 ? across / length : glm::dvec3(0.0);
}

struct EdgeUse {
  glm::dvec3 normal;
  bool sharp = true;
};

std::optional<Found> nearest_edge(std::span<const glm::vec3> positions,
                                  std::span<const std::uint32_t> indices,
                                  std::span<const std::size_t> near, const glm::dvec3& point,
                                  double radius) {
  const auto key = [&](std::size_t triangle, std::size_t edge) {
    return edge_key(positions[indices[3 * triangle + edge]],
                    positions[indices[3 * triangle + (edge + 1) % 3]]);
  };
  std::map<EdgeKey, EdgeUse> edges;
  for (const std::size_t i : near) {
    const glm::dvec3 normal = normal_of(triangle_at(positions, indices, i));
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const auto [use, first] = edges.try_emplace(key(i, edge), EdgeUse{normal});
      if (!first) use->second.sharp = std::abs(glm::dot(use->second.normal, normal)) < flat_cosine;
    }
  }
  std::optional<Found> found;
  for (const std::size_t i : near) {
    const Triangle triangle = triangle_at(positions, indices, i);
    for (int edge = 0; edge < 3; ++edge) {
      if (!edges.at(key(i, static_cast<std::size_t>(edge))).sharp) continue;
      const glm::dvec3 weights = nearest_on_edge(triangle, edge, point);
      const double distance = distance_to(triangle, weights, point);
      if (distance > radius || (found && distance >= glm::length(found->position - point))) {
        continue;
      }
      found = {i, weights, at(triangle, weights)};
    }
  }
  return found;
}

SnappedPoint result(const Found& found, SurfaceFeature feature) {
  return {.triangle = static_cast<std::uint32_t>(found.triangle),
          .barycentrics = glm::vec3(found.weights),
          .position = glm::vec3(found.position),
          .feature = feature};
}

}  // namespace

std::optional<SnappedPoint> snap_to_mesh(std::span<const glm::vec3> positions,
                                         std::span<const std::uint32_t> indices,
                                         const SnapQuery& query) {
  const std::optional<Found> hit = hit_of(positions, indices, query);
  if (!hit) return std::nullopt;
  const double radius = query.radius;
  const bool snaps = radius > 0.0 && (query.vertices || query.edges);
  if (!snaps) return result(*hit, SurfaceFeature::face);
  const auto near = triangles_near(positions, indices, hit->position, radius);
  if (query.vertices) {
    if (const auto vertex = nearest_vertex(positions, indices, near, hit->position, radius)) {
      return result(*vertex, SurfaceFeature::vertex);
    }
  }
  if (query.edges) {
    if (const auto edge = nearest_edge(positions, indices, near, hit->position, radius)) {
      return result(*edge, SurfaceFeature::edge);
    }
  }
  return result(*hit, SurfaceFeature::face);
}

}  // namespace heliograph::scene
