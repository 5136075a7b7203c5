#include "render/kernels/common/met_triangle.hpp"
#include "render/kernels/section/section.hpp"

namespace heliograph::render::kernels {
namespace {

/// The plane through which a ray enters what is left of the scene, and where; no plane: -1.
struct Entrance {
  int plane = -1;
  float at = 0.0f;
};

Entrance entrance(const shared::SectionConstants& section, const shared::Ray& ray) {
  Entrance found;
  for (int i = 0; i < static_cast<int>(section.count); ++i) {
    const glm::vec3 normal(section.planes[i]);
    const float rise = glm::dot(normal, ray.direction);
    if (rise >= 0.0f) continue;
    const float at = (glm::dot(normal, ray.origin) - section.planes[i].w) / -rise;
    if (at > found.at) found = {i, at};
  }
  return found;
}

/// Whether the ray has met the back of a face that has no back.
bool ends_inside(const SceneView& scene, const shared::Hit& hit, const glm::vec3& direction) {
  const MetTriangle triangle = met_triangle(scene, hit);
  const std::uint32_t flags = scene.materials[triangle.material].flags;
  if (flags & (shared::material_double_sided | shared::material_alpha_blend)) return false;
  return glm::dot(triangle.front(), direction) > 0.0f;
}

SectionCap find_cap(const SectionFindJob& job, const shared::Ray& ray, const shared::Hit& hit) {
  if (hit.instance == shared::hit_none) return {0, 0};
  const auto [plane, at] = entrance(job.constants, ray);
  // A ray that begins behind the plane does not enter through it.
  if (plane < 0 || at < ray.t_min * 0.999999f) return {0, 0};
  if (!ends_inside(job.scene, hit, ray.direction)) return {0, 0};
  return {static_cast<std::uint32_t>(plane) + 1, hit.instance + 1};
}

}  // namespace

void section_find(const SectionFindJob& job) {
  const glm::uvec2 extent = job.frame.extent;
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const shared::Ray& ray = job.rays.rays[i];
      const std::uint32_t x = ray.pixel & 0xffffu, y = ray.pixel >> 16;
      if (x < extent.x && y < extent.y) {
        job.caps[y * extent.x + x] = find_cap(job, ray, job.hits[i]);
      }
    }
  });
}

}  // namespace heliograph::render::kernels
