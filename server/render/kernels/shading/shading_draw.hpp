#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/shading.h"

namespace heliograph::render::kernels {

/// shaders/shading/shading_draw.comp
template <class Stage>
struct ShadingDrawBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::Read<Stage> normals;          // rgba32f
  gpu::ReadWrite<Stage> base_color;  // rgba8
  gpu::ReadWrite<Stage> surface;     // rgba8; not read
  gpu::ReadWrite<Stage> emissive;    // rgba16f; not read
};
struct ShadingDrawJob : FrameJob<ShadingDrawBindings, shared::ShadingConstants> {
  SceneView scene;
};

/// On all processors.
void shading_draw(const ShadingDrawJob& job);

}  // namespace heliograph::render::kernels
