#pragma once

#include "gpu/memory/image.hpp"
#include "render/kernels/ray_sink.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/frame_constants.h"

/// The G-buffer from camera rays on all cores: host kernels of
/// shaders/gbuffer/gbuffer_rays.comp and shaders/gbuffer/gbuffer_hits.comp.
namespace heliograph::render::kernels {

/// Writes every ray of the frame, tiles of 8 x 8 pixels one after the other.
void camera_rays(const shared::FrameConstants& frame, shared::RayCount* count, shared::Ray* rays);

/// The mapped images of a G-buffer.
struct GBufferImages {
  gpu::HostView normals;      // rgba32f
  gpu::HostView base_color;   // rgba8
  gpu::HostView surface;      // rgba8
  gpu::HostView motion;       // rgba32f
  gpu::HostView emissive;     // rgba16f
  gpu::HostView depth_slope;  // rg32f
  gpu::HostView instance;     // r32ui
};

struct GBufferJob {
  const shared::FrameConstants& frame;
  SceneView scene;
  bool deforms;     // meshes have vertices of the frame before
  bool last_round;  // nothing goes on
  RaySource rays;
  const shared::Hit* hits;
  RaySink passed;  // rays that go on; begun and ended here
  GBufferImages images;
};

void shade_gbuffer(const GBufferJob& job);

}  // namespace heliograph::render::kernels
