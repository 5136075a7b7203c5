#pragma once

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "render/api/octahedral.hpp"
#include "render/passes/denoise/reproject.hpp"
#include "render/passes/formats.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// As the G-buffer holds it.
inline float stored_roughness(float roughness) {
  return std::round(255.0f * roughness) / 255.0f;
}

/// A guide's texel as shaders/lib/denoise/packed_guide.glsl packs it.
inline glm::uvec2 packed_guide_texel(const glm::vec4& guide) {
  if (guide.w <= 0.0f) return glm::uvec2(0u);
  const float size = glm::length(glm::vec3(guide));
  const glm::vec2 p = glm::round(2047.0f * render::octahedral_encode(glm::vec3(guide) / size));
  const auto axis = [](float value) {  // 12 bits, two's complement
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(value)) & 0xfffu;
  };
  const auto roughness = static_cast<std::uint32_t>(std::round(255.0f * (size - 1.0f)));
  return {glm::floatBitsToUint(guide.w), axis(p.x) | axis(p.y) << 12 | roughness << 24};
}

/// What shaders of a blur by halves are guided by, from what guides all other filters.
inline render::PackedGuide packed_input(FrameRig& rig, const std::vector<glm::vec4>& guide,
                                        const std::vector<glm::vec2>& slope) {
  std::vector<glm::uvec2> surfaces;
  std::vector<std::uint32_t> slopes;
  for (std::size_t i = 0; i < guide.size(); ++i) {
    surfaces.push_back(packed_guide_texel(guide[i]));
    slopes.push_back(guide[i].w > 0.0f ? glm::packHalf2x16(slope[i] / guide[i].w) : 0u);
  }
  return {rig.input("packed.guide", render::formats::two_words, surfaces),
          rig.input("packed.slope", render::formats::two_halves, slopes)};
}

}  // namespace heliograph::test
