#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/gbuffer/gbuffer_triangles.hpp"
#include "render/resources/host_tables.hpp"

namespace heliograph::render::kernels {

/// A pass of the host alone: devices that are not processors draw with their own rasteriser.
template <class Stage>
struct GBufferDrawBindings {
  RaySink<Stage> passed;          // rays that go on behind the nearest triangle
  gpu::Write<Stage> normals;      // rgba32f
  gpu::Write<Stage> base_color;   // rgba8
  gpu::Write<Stage> surface;      // rgba8
  gpu::Write<Stage> motion;       // rgba32f
  gpu::Write<Stage> emissive;     // rgba16f
  gpu::Write<Stage> depth_slope;  // rg32f
  gpu::Write<Stage> instance;     // r32ui
  gpu::OptionalWrite<Stage> layers;
};

struct GBufferDrawJob : FrameJob<GBufferDrawBindings> {
  SceneView scene;
  bool deforms;  // meshes have vertices of the frame before
  const ScreenTriangles& triangles;
};

/// Finds the nearest triangle of every pixel and stores what its surface is, tile by tile on all
/// processors.
void gbuffer_draw(const GBufferDrawJob& job);

}  // namespace heliograph::render::kernels
