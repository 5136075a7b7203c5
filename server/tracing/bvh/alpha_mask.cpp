#include "tracing/bvh/alpha_mask.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "shaders/shared/ray_mask.h"

namespace heliograph::tracing {
namespace {

// Lowest alpha byte that passes "texel x factor >= cutoff"; 256 when none does.
std::uint32_t lowest_alpha(const shared::Material& material) {
  std::uint32_t alpha = 0;
  while (alpha < 256 &&
         static_cast<float>(alpha) / 255.0f * material.base_color.w < material.alpha_cutoff) {
    ++alpha;
  }
  return alpha;
}

// Alpha of a blended surface, scaled to 65535.
std::uint32_t blend_factor(const shared::Material& material) {
  const float factor = std::clamp(material.base_color.w * (1.0f - material.passing), 0.0f, 1.0f);
  return static_cast<std::uint32_t>(std::lround(factor * static_cast<float>(shared::mask_factor)));
}

// Wraps to 0..1; the same as wrap() in shaders/lib/math/nearest_texel.glsl.
float wrap(float coordinate, std::uint32_t mode) {
  if (mode == shared::wrap_clamp) return std::clamp(coordinate, 0.0f, 1.0f);
  if (mode == shared::wrap_mirror) {
    const float folded = coordinate - 2.0f * std::floor(0.5f * coordinate);
    return 1.0f - std::abs(folded - 1.0f);
  }
  return coordinate - std::floor(coordinate);
}

std::uint32_t nearest_texel(float coordinate, std::uint32_t mode, std::uint32_t size) {
  const float scaled = wrap(coordinate, mode) * static_cast<float>(size);
  return std::min(static_cast<std::uint32_t>(scaled), size - 1);
}

}  // namespace

Coverage coverage(const shared::Material& material) {
  if (material.flags & shared::material_alpha_blend) {
    const bool whole =
        blend_factor(material) == shared::mask_factor && material.alpha_mask == shared::no_texture;
    return whole ? Coverage::whole : Coverage::masked;
  }
  if (!(material.flags & shared::material_alpha_mask)) return Coverage::whole;
  if (material.alpha_mask == shared::no_texture) {
    return material.base_color.w < material.alpha_cutoff ? Coverage::none : Coverage::whole;
  }
  const std::uint32_t lowest = lowest_alpha(material);
  if (lowest == 0) return Coverage::whole;
  return lowest > 255 ? Coverage::none : Coverage::masked;
}

bool cover_alike(std::span<const shared::Material> a, std::span<const shared::Material> b) {
  return std::ranges::equal(a, b, [](const shared::Material& one, const shared::Material& other) {
    const bool same_sides = ((one.flags ^ other.flags) & shared::material_double_sided) == 0;
    return same_sides && coverage(one) == coverage(other) && coverage(one) != Coverage::masked;
  });
}

std::uint32_t ray_blending(const shared::Ray& ray, std::uint32_t blending) {
  if (blending == 0) return 0;
  std::uint32_t bits = blending;
  for (const glm::vec3& vector : {ray.direction, ray.origin}) {
    for (int axis = 0; axis < 3; ++axis) {
      bits = shared::mixed_bits(bits ^ std::bit_cast<std::uint32_t>(vector[axis]));
    }
  }
  return bits | 1u;
}

std::uint32_t AlphaMask::alpha(std::span<const std::uint8_t> heap, std::uint32_t triangle, float u,
                               float v) const {
  if (width == 0) return 255;
  const glm::vec2* corners = &uvs[3 * std::size_t(triangle)];
  const glm::vec2 uv = (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
  const std::size_t x = nearest_texel(uv.x, wrap_s, width);
  const std::size_t y = nearest_texel(uv.y, wrap_t, height);
  return heap[texels + y * width + x];
}

bool AlphaMask::stops_ray(std::span<const std::uint8_t> heap, std::uint32_t blending,
                          std::uint32_t instance, std::uint32_t triangle, float u, float v) const {
  return shared::alpha_stops(alpha(heap, triangle, u, v), limit, blending, instance, triangle);
}

AlphaMask make_alpha_mask(const scene::Mesh& mesh, const shared::Material& material) {
  AlphaMask mask;
  if (material.alpha_mask != shared::no_texture) {
    mask.texels = material.alpha_mask;
    mask.width = material.alpha_mask_size & 0xffffu;
    mask.height = material.alpha_mask_size >> 16;
  }
  const bool blended = (material.flags & shared::material_alpha_blend) != 0;
  mask.limit = blended ? shared::mask_blended | blend_factor(material) : lowest_alpha(material);
  mask.wrap_s = material.alpha_mask_wrap & 0xffu;
  mask.wrap_t = material.alpha_mask_wrap >> 8;
  const shared::TextureSlot& slot = material.base_color_texture;
  const glm::vec3 row0(slot.transform_row0), row1(slot.transform_row1);
  mask.uvs.reserve(mesh.indices.size());
  for (const std::uint32_t index : mesh.indices) {
    const shared::Vertex& vertex = mesh.vertices[index];
    const glm::vec3 uv(slot.uv_set == 0 ? vertex.uv0 : vertex.uv1, 1.0f);
    mask.uvs.emplace_back(glm::dot(row0, uv), glm::dot(row1, uv));
  }
  return mask;
}

}  // namespace heliograph::tracing
