#pragma once

#include <cstdint>

#include "render/kernels/common/random.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/transmission.h"

/// The bands of wavelengths that pixels' rays have in volumes that split light into its colours:
/// pixel_band() of shaders/lib/lighting/transmission.glsl.
namespace heliograph::render::kernels {

/// What is added to the sum of a pixel's coordinates in this frame.
inline std::uint32_t band_turn(const shared::FrameConstants& frame) {
  const glm::uvec3 order = pcg3d({frame.sample_index / 3u, shared::band_dimension, frame.seed});
  return (frame.sample_index + order.x % 3u) % 3u;
}

/// 0 red, 1 green, 2 blue.
inline int band_color(int x, int y, std::uint32_t turn) {
  return static_cast<int>((static_cast<std::uint32_t>(x + y) + turn) % 3u);
}

}  // namespace heliograph::render::kernels
