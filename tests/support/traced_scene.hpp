#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/ext/matrix_transform.hpp>
#include <glm/glm.hpp>
#include <random>
#include <utility>
#include <vector>

#include "scene/scene.hpp"
#include "shaders/shared/ray.h"

/// Scenes and rays for tests of tracers, and brute-force ray casting as reference.
namespace heliograph::test {

using Random = std::mt19937;

inline float uniform(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

inline glm::vec3 uniform_vector(Random& random, float size) {
  const float x = uniform(random, -size, size), y = uniform(random, -size, size);
  return {x, y, uniform(random, -size, size)};
}

inline shared::Material plain_material() {
  shared::Material material{};
  material.base_color = glm::vec4(1.0f);
  material.alpha_cutoff = 0.5f;
  material.alpha_mask = shared::no_texture;
  material.base_color_texture.transform_row0 = {1, 0, 0, 0};
  material.base_color_texture.transform_row1 = {0, 1, 0, 0};
  material.base_color_texture.texture = shared::no_texture;
  return material;
}

inline void add_vertex(scene::Mesh& mesh, const glm::vec3& position, const glm::vec2& uv) {
  shared::Vertex vertex{};
  vertex.position = position;
  vertex.uv0 = uv;
  vertex.uv1 = 3.0f * uv;
  mesh.vertices.push_back(vertex);
  mesh.bounds.include(position);
}

/// `count` small random triangles in a cube.
inline scene::Mesh triangle_soup(Random& random, int count, float size) {
  scene::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 center = uniform_vector(random, size);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      add_vertex(mesh, center + uniform_vector(random, 0.3f * size), {});
    }
  }
  return mesh;
}

/// A closed sphere: rays cross its shared edges.
inline scene::Mesh sphere(int rings) {
  scene::Mesh mesh;
  const int columns = 2 * rings;
  for (int y = 0; y <= rings; ++y) {
    for (int x = 0; x <= columns; ++x) {
      const float theta = 3.14159265f * static_cast<float>(y) / static_cast<float>(rings);
      const float phi = 6.28318531f * static_cast<float>(x % columns) / static_cast<float>(columns);
      const float around = y % rings ? std::sin(theta) : 0.0f;  // a pole is a single point
      add_vertex(mesh, {around * std::cos(phi), std::cos(theta), around * std::sin(phi)}, {});
    }
  }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rings; ++y) {
    for (int x = 0; x < columns; ++x) {
      mesh.indices.insert(mesh.indices.end(), {at(x, y), at(x + 1, y), at(x, y + 1)});
      mesh.indices.insert(mesh.indices.end(), {at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

/// Two triangles in the plane y = 0 from -1 to 1; uv from -1 to 2.
inline scene::Mesh quad() {
  scene::Mesh mesh;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    add_vertex(mesh, {corner.x, 0, corner.y}, 0.5f + 1.5f * corner);
  }
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

inline std::uint32_t add_mesh(scene::Scene& scene, scene::Mesh mesh,
                              const shared::Material& material) {
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(material);
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

inline void place(scene::Scene& scene, std::uint32_t mesh, const glm::mat4& world) {
  scene.instances.push_back({mesh, static_cast<std::uint32_t>(scene.nodes.size())});
  scene.nodes.push_back({.name = {}, .parent = {}, .local = world, .world = world});
  for (const shared::Vertex& vertex : scene.meshes[mesh].vertices) {
    scene.bounds.include(glm::vec3(world * glm::vec4(vertex.position, 1.0f)));
  }
}

/// An asymmetric mask of 5 x 3 texels at an unaligned offset in the heap.
inline shared::Material masked_material(scene::Scene& scene, std::uint32_t wrap_s,
                                        std::uint32_t wrap_t) {
  shared::Material material = plain_material();
  material.flags = shared::material_alpha_mask;
  material.base_color.w = 0.8f;
  scene.alpha_heap.insert(scene.alpha_heap.end(), {0, 255, 0});
  material.alpha_mask = static_cast<std::uint32_t>(scene.alpha_heap.size());
  material.alpha_mask_size = 5u | 3u << 16;
  material.alpha_mask_wrap = wrap_s | wrap_t << 8;
  for (int i = 0; i < 15; ++i) scene.alpha_heap.push_back(0x4b2d >> i & 1 ? 220 : 120);
  return material;
}

/// Rotated, mirrored and non-uniformly scaled instances of several meshes, some of them masked.
inline scene::Scene two_level_scene(std::uint32_t seed) {
  Random random(seed);
  scene::Scene scene;
  std::vector<std::uint32_t> meshes{
      add_mesh(scene, triangle_soup(random, 60, 1.0f), plain_material()),
      add_mesh(scene, sphere(8), plain_material()), add_mesh(scene, quad(), plain_material()),
      add_mesh(scene, triangle_soup(random, 1, 1.0f), plain_material())};
  for (std::uint32_t wrap = shared::wrap_repeat; wrap <= shared::wrap_mirror; ++wrap) {
    shared::Material material = masked_material(scene, wrap, shared::wrap_mirror - wrap);
    material.base_color_texture.uv_set = wrap % 2;
    material.base_color_texture.transform_row0 = {1.2f, 0.3f, 0.1f, 0.0f};
    material.base_color_texture.transform_row1 = {-0.2f, 0.7f, 0.4f, 0.0f};
    meshes.push_back(add_mesh(scene, quad(), material));
  }
  for (int i = 0; i < 40; ++i) {
    glm::mat4 world = glm::translate(glm::mat4(1.0f), uniform_vector(random, 4.0f));
    world = glm::rotate(world, uniform(random, 0.0f, 6.0f),
                        glm::normalize(uniform_vector(random, 1.0f) + 1e-3f));
    const float mirror = i % 3 ? 1.0f : -1.0f;
    world = glm::scale(world, glm::vec3(mirror * uniform(random, 0.2f, 1.5f),
                                        uniform(random, 0.2f, 1.5f), uniform(random, 0.2f, 1.5f)));
    place(scene, meshes[static_cast<std::size_t>(i) % meshes.size()], world);
  }
  return scene;
}

/// Rays from inside and around the scene, some along an axis, some short.
inline std::vector<shared::Ray> random_rays(const scene::Scene& scene, std::size_t count,
                                            std::uint32_t seed) {
  Random random(seed);
  const glm::vec3 center = scene.bounds.empty() ? glm::vec3(0.0f) : scene.bounds.center();
  const float radius = scene.bounds.radius();
  std::vector<shared::Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    shared::Ray& ray = rays[i];
    ray.origin = center + uniform_vector(random, radius);
    const glm::vec3 target = center + uniform_vector(random, 0.7f * radius);
    ray.direction = glm::normalize(target - ray.origin);
    if (i % 16 == 0) ray.direction = glm::vec3(0, i % 32 ? 1 : -1, 0);
    ray.t_min = 1e-3f * radius;
    ray.t_max = i % 4 == 0 ? uniform(random, 0.0f, radius) : 1e30f;
    ray.pixel = static_cast<std::uint32_t>(i);
  }
  return rays;
}

/// Texel index after glTF wrapping.
inline int wrapped_texel(double coordinate, std::uint32_t mode, int size) {
  int texel = static_cast<int>(std::floor(coordinate * size));
  if (mode == shared::wrap_clamp) return std::min(std::max(texel, 0), size - 1);
  const int period = mode == shared::wrap_mirror ? 2 * size : size;
  texel = ((texel % period) + period) % period;
  return texel < size ? texel : period - 1 - texel;
}

inline bool passes_alpha_test(const scene::Scene& scene, const scene::Mesh& mesh,
                              std::size_t triangle, double u, double v) {
  const shared::Material& material = scene.materials[mesh.material];
  if (!(material.flags & shared::material_alpha_mask)) return true;
  if (material.alpha_mask == shared::no_texture) {
    return material.base_color.w >= material.alpha_cutoff;
  }
  const shared::TextureSlot& slot = material.base_color_texture;
  const auto uv_at = [&](std::size_t corner) {
    const shared::Vertex& vertex = mesh.vertices[mesh.indices[3 * triangle + corner]];
    return glm::dvec2(slot.uv_set == 0 ? vertex.uv0 : vertex.uv1);
  };
  const glm::dvec3 uv((1.0 - u - v) * uv_at(0) + u * uv_at(1) + v * uv_at(2), 1.0);
  const double s = glm::dot(glm::dvec3(glm::vec3(slot.transform_row0)), uv);
  const double t = glm::dot(glm::dvec3(glm::vec3(slot.transform_row1)), uv);
  const int width = static_cast<int>(material.alpha_mask_size & 0xffffu);
  const int x = wrapped_texel(s, material.alpha_mask_wrap & 0xffu, width);
  const int y = wrapped_texel(t, material.alpha_mask_wrap >> 8,
                              static_cast<int>(material.alpha_mask_size >> 16));
  const double alpha =
      scene.alpha_heap[material.alpha_mask + static_cast<std::size_t>(y * width + x)];
  return alpha / 255.0 * material.base_color.w >= material.alpha_cutoff;
}

/// The closest hit by testing every triangle in double precision and world space.
inline shared::Hit closest_hit_brute_force(const scene::Scene& scene, const shared::Ray& ray) {
  shared::Hit hit{};
  hit.instance = shared::hit_none;
  double nearest = ray.t_max;
  const glm::dvec3 origin(ray.origin), direction(ray.direction);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const glm::dmat4 world(scene.nodes[scene.instances[i].node].world);
    if (glm::determinant(world) == 0.0) continue;
    const auto corner = [&](std::size_t index) {
      const glm::dvec3 position(mesh.vertices[mesh.indices[index]].position);
      return glm::dvec3(world * glm::dvec4(position, 1.0));
    };
    for (std::size_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) {
      const glm::dvec3 a = corner(3 * triangle);
      const glm::dvec3 edge1 = corner(3 * triangle + 1) - a, edge2 = corner(3 * triangle + 2) - a;
      const glm::dvec3 p = glm::cross(direction, edge2);
      const double determinant = glm::dot(edge1, p);
      if (determinant == 0.0) continue;
      const glm::dvec3 s = origin - a;
      const double u = glm::dot(s, p) / determinant;
      const glm::dvec3 q = glm::cross(s, edge1);
      const double v = glm::dot(direction, q) / determinant;
      const double t = glm::dot(edge2, q) / determinant;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= ray.t_min || t >= nearest) continue;
      if (!passes_alpha_test(scene, mesh, triangle, u, v)) continue;
      nearest = t;
      hit = {static_cast<float>(t),
             static_cast<std::uint32_t>(i),
             static_cast<std::uint32_t>(triangle),
             static_cast<float>(u),
             static_cast<float>(v),
             0,
             0,
             0};
    }
  }
  return hit;
}

/// Whether two hits of one ray agree: same triangle or same distance.
inline bool same_hit(const shared::Hit& a, const shared::Hit& b) {
  if (a.instance == shared::hit_none || b.instance == shared::hit_none) {
    return a.instance == b.instance;
  }
  if (a.instance == b.instance && a.triangle == b.triangle) return true;
  return std::abs(a.t - b.t) < 1e-4f * std::max(a.t, b.t);
}

}  // namespace heliograph::test
