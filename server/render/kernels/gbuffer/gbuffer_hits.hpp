#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/host_tables.hpp"

/// The G-buffer from camera rays on all processors, in vectors.
namespace heliograph::render::kernels {

/// shaders/gbuffer/gbuffer_rays.comp
template <class Stage>
struct GBufferRaysBindings {
  gpu::WriteBuffer<Stage, shared::RayCount> count;
  gpu::WriteBuffer<Stage, shared::Ray> rays;
};
struct GBufferRaysJob : FrameJob<GBufferRaysBindings> {
  Rows rows;  // whole tiles, but for the last of the frame
};

/// Writes the rays of these rows, tiles of 8 x 8 pixels one after the other.
void gbuffer_rays(const GBufferRaysJob& job);

/// shaders/gbuffer/gbuffer_hits.comp, or gbuffer_hits_layered.comp, which writes `layers`.
template <class Stage>
struct GBufferHitsBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadBuffer<Stage, shared::Vertex> previous_vertices;
  RaySink<Stage> passed;          // rays that go on
  gpu::Write<Stage> normals;      // rgba32f
  gpu::Write<Stage> base_color;   // rgba8
  gpu::Write<Stage> surface;      // rgba8
  gpu::Write<Stage> motion;       // rgba32f
  gpu::Write<Stage> emissive;     // rgba16f
  gpu::Write<Stage> depth_slope;  // rg32f
  gpu::Write<Stage> instance;     // r32ui
  gpu::OptionalWrite<Stage> layers;
};
struct GBufferHitsConstants {
  std::uint32_t last_round;  // 1: nothing goes on
};

struct GBufferHitsJob : FrameJob<GBufferHitsBindings, GBufferHitsConstants> {
  SceneView scene;
  bool deforms;  // meshes have vertices of the frame before
};

void gbuffer_hits(const GBufferHitsJob& job);

}  // namespace heliograph::render::kernels
