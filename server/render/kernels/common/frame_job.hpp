#pragma once

#include "gpu/frame_plan/bindings.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/scene.h"

namespace heliograph::render::kernels {

/// What most host kernels get: their pass and what its shader reads from the frame's set.
template <template <class> class Bindings, class Constants = gpu::NoConstants>
struct FrameJob : gpu::HostPass<Bindings, Constants> {
  const shared::FrameConstants& frame;
};

/// A square table of floats in the host's memory.
struct SquareTexels {
  gpu::HostView texels;
  int size;
};

/// What the lobes of surfaces look up.
struct LobeTables {
  SquareTexels split_sum;  // rg32f: scales and biases of F0
  SquareTexels sheen;      // r32f: albedos of the white lobe
  SquareTexels ltc;        // rgba32f: linearly transformed cosines
};

/// Whether a scene with these features has materials with layers: kernels leave out what they need
/// of all others.
inline bool has_layers(std::uint32_t features) {
  return (features & shared::scene_layers) != 0;
}

/// Whether a scene with these features may have volumes that split light into its colours.
inline bool disperses(std::uint32_t features) {
  return (features & shared::scene_disperses) != 0;
}

/// Whether a scene with these features may have surfaces that scatter light to their other side.
inline bool scatters_through(std::uint32_t features) {
  return (features & shared::scene_diffuse_transmits) != 0;
}

}  // namespace heliograph::render::kernels
