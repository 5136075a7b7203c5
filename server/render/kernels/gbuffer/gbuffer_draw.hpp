#pragma once

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/kernels/blend/blended.hpp"
#include "render/kernels/gbuffer/gbuffer_triangles.hpp"
#include "render/resources/host_tables.hpp"

namespace heliograph::render::kernels {

/// A pass of the host alone: devices that are not processors draw with their own rasteriser.
template <class Stage>
struct GBufferDrawBindings {
  gpu::Write<Stage> normals;      // rgba32f
  gpu::Write<Stage> base_color;   // rgba8
  gpu::Write<Stage> surface;      // rgba8
  gpu::Write<Stage> motion;       // rgba32f
  gpu::Write<Stage> emissive;     // rgba16f
  gpu::Write<Stage> depth_slope;  // rg32f
  gpu::Write<Stage> instance;     // r32ui
  gpu::OptionalWrite<Stage> layers;
  // As blended_rays and blended_surfaces leave them; in scenes without blended surfaces, none.
  gpu::OptionalWrite<Stage> blended_radiance;       // rgba32f
  gpu::OptionalWrite<Stage> blended_transmittance;  // rgba32f
  gpu::OptionalWrite<Stage> blended_motion;         // rgba32f
  gpu::OptionalWrite<Stage> blended_surface;        // rgba8
  gpu::OptionalWrite<Stage> blended_specular;       // rgba32f
  gpu::OptionalWriteBuffer<Stage, shared::Hit> blended_chosen;
};

struct GBufferDrawJob : FrameJob<GBufferDrawBindings> {
  SceneView scene;
  bool deforms;  // meshes have vertices of the frame before
  const ScreenTriangles& triangles;
  std::uint32_t rounds;          // the surface of the last is taken as it is
  std::uint32_t blended_rounds;  // in which blended surfaces are laid over; fewer
  const LitScene* blended;       // null: they are passed only
  const gpu::FramePlan& plan;    // no tiles are drawn once its frame is canceled
};

/// Finds the nearest triangle of every pixel and stores what its surface is, tile by tile on all
/// processors. Where it lets rays pass, the next one behind it is drawn, and so on (depth peeling,
/// Everitt 2001); blended surfaces that are passed are laid over each other on the way.
void gbuffer_draw(const GBufferDrawJob& job);

}  // namespace heliograph::render::kernels
