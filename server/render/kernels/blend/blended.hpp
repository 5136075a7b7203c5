#pragma once

#include <span>

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/radiance_cache.h"

/// Blended surfaces on all processors, in vectors.
namespace heliograph::render::kernels {

/// shaders/blend/blended_rays.comp
template <class Stage>
struct BlendedRaysBindings {
  gpu::Read<Stage> motion;  // rgba32f
  RaySink<Stage> rays;
  gpu::Write<Stage> radiance;       // rgba32f
  gpu::Write<Stage> transmittance;  // rgba32f
  gpu::Write<Stage> front_motion;   // rgba32f
  gpu::Write<Stage> surface;        // rgba8
  gpu::Write<Stage> specular;       // rgba32f
};
struct BlendedRaysConstants {
  glm::uvec4 region;  // of pixels: first, behind the last
};
using BlendedRaysJob = FrameJob<BlendedRaysBindings, BlendedRaysConstants>;
void blended_rays(const BlendedRaysJob& job);

/// What lights surfaces, and what they are.
struct LitScene {
  bool layered;  // materials of the scene have layers
  SceneView scene;
  const Environment& environment;
  std::span<const shared::Light> lights;
  LobeTables tables;
};

/// shaders/blend/blended_surfaces.comp
template <class Stage>
struct BlendedSurfacesBindings {
  RaySource<Stage> met;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadBuffer<Stage, shared::Vertex> previous_vertices;
  RaySink<Stage> rays;                          // that go on
  gpu::ReadWrite<Stage> radiance;               // rgba32f; a: sum of all weights
  gpu::ReadWrite<Stage> transmittance;          // rgba32f; a: weight of the chosen surface
  gpu::Write<Stage> front_motion;               // rgba32f
  gpu::WriteBuffer<Stage, shared::Hit> chosen;  // by pixel
  RaySink<Stage> lit;
};
struct BlendedSurfacesConstants {
  std::uint32_t round;
  std::uint32_t last_round;
};
struct BlendedSurfacesJob : FrameJob<BlendedSurfacesBindings, BlendedSurfacesConstants> {
  LitScene lit_scene;
  bool deforms;  // meshes have vertices of the frame before
};
void blended_surfaces(const BlendedSurfacesJob& job);

/// A pass of the host alone, where its rasteriser has found the blended surfaces: lists the pixels
/// that have one to light.
template <class Stage>
struct BlendedLitBindings {
  gpu::Read<Stage> radiance;  // rgba32f; a: sum of all weights
  RaySink<Stage> lit;
};
using BlendedLitJob = FrameJob<BlendedLitBindings>;
void blended_lit(const BlendedLitJob& job);

/// shaders/blend/blended_light.comp
template <class Stage>
struct BlendedLightBindings {
  RaySource<Stage> lit;
  gpu::ReadBuffer<Stage, shared::Hit> chosen;  // by pixel
  gpu::Read<Stage> radiance;                   // rgba32f
  gpu::ReadWrite<Stage> transmittance;         // rgba32f; a: from weight to view Z
  gpu::Write<Stage> surface;                   // rgba8
  RaySink<Stage> shadows, ambient, specular;
};
struct BlendedLightConstants {
  float max_roughness;    // below 0: no reflections are traced
  float rough_rate;       // fraction of the rays that rough surfaces reflect which are traced
  std::uint32_t gathers;  // 1: rays of the ambient stream gather indirect light
};
struct BlendedLightJob : FrameJob<BlendedLightBindings, BlendedLightConstants> {
  LitScene lit_scene;
};
void blended_light(const BlendedLightJob& job);

/// shaders/blend/blended_gather.comp
template <class Stage>
struct BlendedGatherBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadWriteBuffer<Stage, std::uint32_t> keys;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
  gpu::ReadWrite<Stage> radiance;  // rgba32f
};
struct BlendedGatherJob : FrameJob<BlendedGatherBindings, shared::RadianceCacheConstants> {
  bool layered;  // materials of the scene have layers
  SceneView scene;
  const Environment& environment;
  LobeTables tables;
};
void blended_gather(const BlendedGatherJob& job);

/// shaders/blend/blended_enter.comp
template <class Stage>
struct BlendedEnterBindings {
  RaySource<Stage> lit;
  gpu::ReadBuffer<Stage, shared::Hit> chosen;  // by pixel
  gpu::Read<Stage> radiance;                   // rgba32f; a: sum of all weights
  gpu::Read<Stage> transmittance;              // rgba32f; a: weight of the chosen surface
  RaySink<Stage> inside, refracted;            // into volumes; through thin walls
};
struct BlendedEnterJob : FrameJob<BlendedEnterBindings> {
  LitScene lit_scene;
};
void blended_enter(const BlendedEnterJob& job);

/// shaders/blend/blended_refract.comp
template <class Stage>
struct BlendedRefractBindings {
  RaySource<Stage> inside;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadBuffer<Stage, shared::Hit> chosen;  // by pixel
  RaySink<Stage> next, refracted;
};
struct BlendedRefractConstants {
  std::uint32_t round;
  std::uint32_t last_round;
};
struct BlendedRefractJob : FrameJob<BlendedRefractBindings, BlendedRefractConstants> {
  LitScene lit_scene;
};
void blended_refract(const BlendedRefractJob& job);

/// shaders/blend/blended_through.comp
template <class Stage>
struct BlendedThroughBindings {
  RaySource<Stage> rays;
  gpu::ReadWrite<Stage> radiance;  // rgba32f
  gpu::ReadWrite<Stage> specular;  // rgba32f; a: how far the rays went
};
struct BlendedThroughConstants {
  std::uint32_t leaves;  // 1: the light stays where it is, for blended_bands()
};
struct BlendedThroughJob : FrameJob<BlendedThroughBindings, BlendedThroughConstants> {
  RadianceMap background;  // what the camera sees behind the scene
};
void blended_through(const BlendedThroughJob& job);

/// shaders/blend/blended_bands.comp
template <class Stage>
struct BlendedBandsBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> chosen;  // by pixel
  gpu::Read<Stage> through;                    // rgba32f; a: 0: no ray
  gpu::ReadWrite<Stage> radiance;              // rgba32f
};
struct BlendedBandsJob : FrameJob<BlendedBandsBindings> {
  SceneView scene;
};
void blended_bands(const BlendedBandsJob& job);

/// shaders/blend/blended_empty.comp
template <class Stage>
struct BlendedEmptyBindings {
  RaySource<Stage> rays;
  gpu::Write<Stage> emptied;  // rgba32f
};
using BlendedEmptyJob = gpu::HostPass<BlendedEmptyBindings>;
void blended_empty(const BlendedEmptyJob& job);

/// shaders/blend/blended_over.comp
template <class Stage>
struct BlendedOverBindings {
  gpu::Read<Stage> radiance, specular, transmittance;  // rgba32f
  gpu::ReadWrite<Stage> frame;                         // rgba32f
};
using BlendedOverJob = gpu::HostPass<BlendedOverBindings>;
void blended_over(const BlendedOverJob& job);

}  // namespace heliograph::render::kernels
