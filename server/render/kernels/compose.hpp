#pragma once

#include <optional>
#include <span>

#include "gpu/memory/image.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/scene.h"

namespace heliograph::render::kernels {

/// The mapped images that composition reads and writes.
struct ComposeJob {
  const shared::FrameConstants& frame;
  std::span<const shared::Light> lights;  // punctual, the environment's sun among them
  gpu::HostView split_sum;                // rg32f, square
  int split_sum_size;
  float max_roughness;  // below 0: no specular rays were traced
  int width;
  int height;

  gpu::HostView normals, base_color, surface, motion, emissive, background;
  gpu::HostView shadows, ambient, specular;  // raw
  struct Denoised {
    gpu::HostView visibility, specular;
    gpu::HostView hdr_raw;  // written
  };
  std::optional<Denoised> denoised;
  gpu::HostView hdr;  // written
};

/// Whether the kernel knows all that these settings ask of it: it does not look up the prefiltered
/// environment.
bool can_compose(const shared::FrameConstants& frame, float max_roughness);

/// Composes the frame from its signals on all cores: shaders/compose/compose.comp, or
/// compose_denoised.comp where there are denoised signals, in the widest vectors that the processor
/// has.
void compose(const ComposeJob& job);

}  // namespace heliograph::render::kernels
