#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::tracing {

/// Coverage of a material for rays: partial for glTF's alphaMode MASK and BLEND.
enum class Coverage { whole, masked, none };

Coverage coverage(const shared::Material& material);
/// Whether an acceleration structure of a scene with materials `a` is also one with `b`: rays meet
/// the same, from the same sides, and look up no mask.
bool cover_alike(std::span<const shared::Material> a, std::span<const shared::Material> b);

/// A random number of a ray that decides which blended surfaces stop it, like ray_blending() in
/// shaders. `blending`: seed of its stream; 0: all blended surfaces stop it.
std::uint32_t ray_blending(const shared::Ray& ray, std::uint32_t blending);

/// Alpha test of rays for a mesh with partial coverage.
struct AlphaMask {
  std::uint32_t texels = 0;  // offset into the scene's alpha heap
  std::uint32_t width = 0;   // 0: no texture, alpha is 255 all over
  std::uint32_t height = 0;
  std::uint32_t limit = 0;  // lowest alpha, of 255, that stops a ray; or see shared::mask_blended
  std::uint32_t wrap_s = shared::wrap_repeat;
  std::uint32_t wrap_t = shared::wrap_repeat;
  std::vector<glm::vec2> uvs;  // three per triangle, texture transform applied

  /// Whether a ray stops at barycentric (u, v) of `triangle`. `heap`: the scene's alpha heap.
  /// `blending`: ray_blending() of the ray.
  bool stops_ray(std::span<const std::uint8_t> heap, std::uint32_t blending, std::uint32_t instance,
                 std::uint32_t triangle, float u, float v) const;

 private:
  /// Alpha of 255 at barycentric (u, v).
  std::uint32_t alpha(std::span<const std::uint8_t> heap, std::uint32_t triangle, float u,
                      float v) const;
};

AlphaMask make_alpha_mask(const scene::Mesh& mesh, const shared::Material& material);

}  // namespace heliograph::tracing
