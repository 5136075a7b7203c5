#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::tracing {

/// How much of a material's surface rays meet: glTF alphaMode MASK, everything else is whole.
enum class Coverage { whole, masked, none };

Coverage coverage(const shared::Material& material);

/// Where rays pass through a mesh of masked coverage.
struct AlphaMask {
  std::uint32_t texels = 0;  // offset into the scene's alpha heap
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t threshold = 0;  // lowest alpha, of 255, that stops a ray
  std::uint32_t wrap_s = shared::wrap_repeat;
  std::uint32_t wrap_t = shared::wrap_repeat;
  std::vector<glm::vec2> uvs;  // three per triangle, texture transform applied

  /// Whether a ray through barycentric (u, v) of `triangle` ends there. `heap`: the scene's.
  bool stops_ray(std::span<const std::uint8_t> heap, std::uint32_t triangle, float u,
                 float v) const;
};

AlphaMask make_alpha_mask(const scene::Mesh& mesh, const shared::Material& material);

}  // namespace heliograph::tracing
