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

/// A square table in the host's memory, rg32f: scales and biases of F0 (split sum).
struct SplitSum {
  gpu::HostView texels;
  int size;
};

/// Whether kernels know the materials of a scene with these features: glTF's own model alone.
inline bool know_materials(std::uint32_t features) {
  return (features & shared::scene_layers) == 0;
}

/// The same of its lights: punctual ones alone.
inline bool know_lights(std::uint32_t features) {
  return (features & shared::scene_area_lights) == 0;
}

}  // namespace heliograph::render::kernels
