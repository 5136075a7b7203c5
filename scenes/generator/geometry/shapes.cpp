#include "scenes/generator/geometry/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

// Joins vertices laid out row by row, `columns + 1` to a row, into quads.
void join_grid(Mesh& mesh, std::uint32_t first, int columns, int rows) {
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t corner = first + std::uint32_t(row) * stride + std::uint32_t(column);
      mesh.add_triangle(corner, corner + 1, corner + stride + 1);
      mesh.add_triangle(corner, corner + stride + 1, corner + stride);
    }
  }
}

}  // namespace

Mesh patch(int columns, int rows, const std::function<SurfacePoint(float, float)>& surface) {
  Mesh mesh;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const SurfacePoint point = surface(float(column) / float(columns), float(row) / float(rows));
      mesh.vertices.push_back({point.position, glm::normalize(point.normal), {}, point.uv});
    }
  }
  join_grid(mesh, 0, columns, rows);
  return mesh;
}

Mesh smooth_patch(int columns, int rows, glm::vec2 extent,
                  const std::function<glm::dvec3(double, double)>& position) {
  constexpr double step = 1e-5;
  return patch(columns, rows, [&](float u, float v) {
    const glm::dvec3 along_u = position(u + step, v) - position(u - step, v);
    const glm::dvec3 along_v = position(u, v + step) - position(u, v - step);
    return SurfacePoint{glm::vec3(position(u, v)),
                        glm::vec3(glm::normalize(glm::cross(along_u, along_v))),
                        glm::vec2(u, v) * extent};
  });
}

Mesh lathe(const Profile& profile, int segments, float reference_radius, float tile) {
  const float repeats = std::max(1.0f, std::round(2.0f * pi * reference_radius / tile));
  Mesh mesh;
  for (const auto& run : profile.runs()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const ProfilePoint& point : run) {
      for (int segment = 0; segment <= segments; ++segment) {
        const float turn = float(segment) / float(segments);
        // Exactly the same position on both sides of the seam.
        const float angle = 2.0f * pi * (segment == segments ? 0.0f : turn);
        const glm::vec3 spoke(std::cos(angle), 0.0f, -std::sin(angle));
        const glm::vec3 position =
            spoke * point.position.x + glm::vec3(0.0f, point.position.y, 0.0f);
        const glm::vec3 normal = spoke * point.normal.x + glm::vec3(0.0f, point.normal.y, 0.0f);
        mesh.vertices.push_back(
            {position, glm::normalize(normal), {}, {turn * repeats * tile, -point.distance}});
      }
    }
    join_grid(mesh, first, segments, int(run.size()) - 1);
  }
  return mesh;
}

Mesh sweep(const Profile& profile, const std::vector<Station>& stations) {
  Mesh mesh;
  for (const auto& run : profile.runs()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const ProfilePoint& point : run) {
      for (const Station& station : stations) {
        const glm::vec3 position =
            station.origin + station.axis_x * point.position.x + station.axis_y * point.position.y;
        const glm::vec3 normal = station.axis_x * point.normal.x + station.axis_y * point.normal.y;
        mesh.vertices.push_back(
            {position, glm::normalize(normal), {}, {station.distance, -point.distance}});
      }
    }
    join_grid(mesh, first, int(stations.size()) - 1, int(run.size()) - 1);
  }
  return mesh;
}

std::vector<Station> straight_stations(float length, int segments) {
  std::vector<Station> stations;
  for (int i = 0; i <= segments; ++i) {
    const float along = length * float(i) / float(segments);
    stations.push_back({{along - 0.5f * length, 0.0f, 0.0f}, {0, 0, 1}, {0, 1, 0}, along});
  }
  return stations;
}

std::vector<Station> arch_stations(int segments, float reference_radius, float from_angle,
                                   float to_angle) {
  std::vector<Station> stations;
  for (int i = 0; i <= segments; ++i) {
    const float angle = glm::mix(from_angle, to_angle, float(i) / float(segments));
    stations.push_back({glm::vec3(0.0f),
                        {std::cos(angle), std::sin(angle), 0.0f},
                        {0.0f, 0.0f, 1.0f},
                        angle * reference_radius});
  }
  return stations;
}

Mesh quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const glm::vec3 normal = glm::normalize(glm::cross(c - a, d - b));
  const float width = glm::distance(a, b);
  const float height = glm::distance(a, d);
  Mesh mesh;
  mesh.vertices = {{a, normal, {}, {0, height}},
                   {b, normal, {}, {width, height}},
                   {c, normal, {}, {width, 0}},
                   {d, normal, {}, {0, 0}}};
  mesh.add_triangle(0, 1, 2);
  mesh.add_triangle(0, 2, 3);
  return mesh;
}

Mesh quad_facing(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, glm::vec3 outward) {
  const bool facing = glm::dot(glm::cross(c - a, d - b), outward) >= 0.0f;
  return facing ? quad(a, b, c, d) : quad(b, a, d, c);
}

Mesh rectangular_moulding(const Profile& profile, glm::vec2 half_extents) {
  Mesh mesh;
  for (int side = 0; side < 4; ++side) {
    const float turn = 0.5f * pi * float(side);
    const glm::vec3 outward(std::round(std::sin(turn)), 0.0f, std::round(std::cos(turn)));
    const glm::vec3 along(outward.z, 0.0f, -outward.x);
    const float half_depth = side % 2 == 0 ? half_extents.y : half_extents.x;
    const float half_length = side % 2 == 0 ? half_extents.x : half_extents.y;
    for (const auto& run : profile.runs()) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const ProfilePoint& point : run) {
        for (const float end : {-1.0f, 1.0f}) {
          const float reach = end * (half_length + point.position.x);
          mesh.vertices.push_back(
              {outward * (half_depth + point.position.x) + along * reach +
                   glm::vec3(0.0f, point.position.y, 0.0f),
               glm::normalize(outward * point.normal.x + glm::vec3(0.0f, point.normal.y, 0.0f)),
               {},
               {reach, -point.distance}});
        }
      }
      join_grid(mesh, first, 1, int(run.size()) - 1);
    }
  }
  return mesh;
}

Mesh box(glm::vec3 size) {
  const glm::vec3 h = 0.5f * size;
  Mesh mesh;
  mesh.append(quad({-h.x, -h.y, h.z}, {h.x, -h.y, h.z}, {h.x, h.y, h.z}, {-h.x, h.y, h.z}));
  mesh.append(quad({h.x, -h.y, -h.z}, {-h.x, -h.y, -h.z}, {-h.x, h.y, -h.z}, {h.x, h.y, -h.z}));
  mesh.append(quad({h.x, -h.y, h.z}, {h.x, -h.y, -h.z}, {h.x, h.y, -h.z}, {h.x, h.y, h.z}));
  mesh.append(quad({-h.x, -h.y, -h.z}, {-h.x, -h.y, h.z}, {-h.x, h.y, h.z}, {-h.x, h.y, -h.z}));
  mesh.append(quad({-h.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, -h.z}, {-h.x, h.y, -h.z}));
  mesh.append(quad({-h.x, -h.y, -h.z}, {h.x, -h.y, -h.z}, {h.x, -h.y, h.z}, {-h.x, -h.y, h.z}));
  return mesh;
}

namespace {

// One face of a bevelled box in its own frame: the face itself, and half of its bevels (the edge
// bevels along +a and along +b and the corner triangles of the +normal side are added once).
void add_bevel_strip(Mesh& mesh, glm::vec3 first_axis, glm::vec3 second_axis, glm::vec3 along,
                     glm::vec3 half, float bevel) {
  const auto reach = [&](glm::vec3 axis) { return std::abs(glm::dot(axis, half)); };
  const float outer_first = reach(first_axis);
  const float outer_second = reach(second_axis);
  const float length = reach(along) - bevel;
  const glm::vec3 upper = first_axis * outer_first + second_axis * (outer_second - bevel);
  const glm::vec3 lower = first_axis * (outer_first - bevel) + second_axis * outer_second;
  Mesh strip = quad(upper - along * length, upper + along * length, lower + along * length,
                    lower - along * length);
  if (glm::dot(strip.vertices[0].normal, first_axis + second_axis) < 0.0f) {
    strip = quad(lower - along * length, lower + along * length, upper + along * length,
                 upper - along * length);
  }
  mesh.append(strip);
}

void add_bevel_corner(Mesh& mesh, glm::vec3 signs, glm::vec3 half, float bevel) {
  const glm::vec3 tip = signs * half;
  const glm::vec3 normal = glm::normalize(signs);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 point = tip - signs * bevel;
    point[axis] = tip[axis];
    mesh.vertices.push_back({point, normal, {}, {point.x + point.z, -point.y}});
  }
  mesh.add_triangle(first, first + 1, first + 2);
}

}  // namespace

Mesh bevelled_box(glm::vec3 size, float bevel) {
  const glm::vec3 half = 0.5f * size;
  const float b = std::min(bevel, 0.45f * std::min({size.x, size.y, size.z}));
  Mesh mesh;
  const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // The six faces, shrunk by the bevel and pushed back out to the surface of the full box.
  const Mesh shrunk = box(size - glm::vec3(2.0f * b));
  for (std::size_t i = 0; i < shrunk.vertices.size(); ++i) {
    Vertex vertex = shrunk.vertices[i];
    vertex.position += vertex.normal * b;
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = shrunk.indices;
  for (int axis = 0; axis < 3; ++axis) {
    for (int signs = 0; signs < 4; ++signs) {
      const glm::vec3 first_axis = axes[(axis + 1) % 3] * (signs & 1 ? -1.0f : 1.0f);
      const glm::vec3 second_axis = axes[(axis + 2) % 3] * (signs & 2 ? -1.0f : 1.0f);
      add_bevel_strip(mesh, first_axis, second_axis, axes[axis], half, b);
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    add_bevel_corner(
        mesh, {corner & 1 ? -1.0f : 1.0f, corner & 2 ? -1.0f : 1.0f, corner & 4 ? -1.0f : 1.0f},
        half, b);
  }
  return mesh;
}

Mesh sphere(float radius, int segments, int rings, glm::vec2 uv_extent) {
  return patch(segments, rings, [&](float u, float v) {
    const float azimuth = 2.0f * pi * (u < 1.0f ? u : 0.0f);
    const float polar = pi * v;
    const float ring = v > 0.0f && v < 1.0f ? std::sin(polar) : 0.0f;
    const glm::vec3 normal(std::cos(azimuth) * ring, std::cos(polar), -std::sin(azimuth) * ring);
    return SurfacePoint{radius * normal, normal, glm::vec2(u, v) * uv_extent};
  });
}

Mesh torus(float ring_radius, float tube_radius, int segments, int sides) {
  return patch(segments, sides, [&](float u, float v) {
    const float around = 2.0f * pi * (u < 1.0f ? u : 0.0f);
    const float tube = 2.0f * pi * (v < 1.0f ? v : 0.0f);
    const glm::vec3 spoke(std::cos(around), 0.0f, -std::sin(around));
    const glm::vec3 normal = spoke * std::cos(tube) + glm::vec3(0.0f, std::sin(tube), 0.0f);
    return SurfacePoint{spoke * ring_radius + normal * tube_radius,
                        normal,
                        {2.0f * pi * ring_radius * u, -2.0f * pi * tube_radius * v}};
  });
}

Mesh disc(float radius, int segments) {
  Mesh mesh;
  mesh.vertices.push_back({});
  for (int i = 0; i < segments; ++i) {
    const float angle = 2.0f * pi * float(i) / float(segments);
    const glm::vec3 rim(radius * std::cos(angle), 0.0f, -radius * std::sin(angle));
    mesh.vertices.push_back({rim, {0, 1, 0}, {}, {rim.x, rim.z}});
  }
  for (int i = 0; i < segments; ++i) {
    mesh.add_triangle(0, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % segments));
  }
  return mesh;
}

}  // namespace heliograph::scenes
