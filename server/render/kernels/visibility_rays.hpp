#pragma once

#include <span>

#include "gpu/memory/image.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/scene.h"

namespace heliograph::render::kernels {

/// The mapped images that the generation of visibility rays reads and writes.
struct VisibilityRaysJob {
  const shared::FrameConstants& frame;
  int width;
  int height;
  gpu::HostView normals, motion;
  shared::RayCount* count;  // of an emptied stream
  shared::Ray* rays;
  gpu::HostView visibility;  // written: 1 where the ray decides, 0 where there is none to trace
};

struct ShadowRaysJob {
  VisibilityRaysJob common;
  std::span<const shared::Light> lights;  // punctual, the environment's sun among them
  gpu::HostView base_color, surface;
  gpu::HostView split_sum;  // rg32f, square
  int split_sum_size;
};

/// One ray per pixel toward one light on all processors: shaders/visibility/shadows_rays.comp in
/// the widest vectors that the processor has. The stream holds the same rays in another order.
void shadow_rays(const ShadowRaysJob& job);

/// One ray per pixel over the hemisphere: shaders/visibility/ambient_rays.comp.
void ambient_rays(const VisibilityRaysJob& job);

}  // namespace heliograph::render::kernels
