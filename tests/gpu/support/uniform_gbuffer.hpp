#pragma once

#include <cmath>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// The surface that a synthetic G-buffer has in every pixel.
struct SurfacePixel {
  glm::vec3 normal{0, 0, 1};
  glm::vec3 color{1.0f};
  float occlusion = 1.0f;
  float roughness = 1.0f;
  float metallic = 0.0f;
  bool unlit = false;
  glm::vec3 emissive{0.0f};  // multiples of 1/1024 below 2 are exact
  float view_z = 2.0f;       // 0: background
};

/// Octahedral encoding of a unit vector (Cigolle et al. 2014).
inline glm::vec2 octahedral(const glm::vec3& d) {
  const glm::vec2 p = glm::vec2(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  if (d.z >= 0.0f) return p;
  return {(1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
          (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f)};
}

/// A synthetic G-buffer with `pixel` everywhere.
render::GBuffer make_uniform_gbuffer(FrameRig& rig, const SurfacePixel& pixel);

}  // namespace heliograph::test
