#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/host_tables.hpp"
#include "render/resources/lights/light_grid.hpp"
#include "shaders/shared/radiance_cache.h"

/// Reflections on all processors, in vectors.
namespace heliograph::render::kernels {

/// shaders/reflections/specular_rays.comp, or specular_rays_half.comp, which writes `directions`:
/// one pixel of each 2 x 2 traces.
template <class Stage>
struct SpecularRaysBindings {
  gpu::Read<Stage> normals;     // rgba32f
  gpu::Read<Stage> base_color;  // rgba8
  gpu::Read<Stage> surface;     // rgba8
  gpu::Read<Stage> layers;
  gpu::Read<Stage> motion;  // rgba32f
  RaySink<Stage> rays;
  gpu::Read<Stage> planned;              // r32ui, shaders/shared/sampling.h, or anything
  gpu::Write<Stage> radiance;            // rgba32f; cleared; w < 0 where the plan leaves it out
  gpu::OptionalWrite<Stage> directions;  // rgba32f
};
struct SpecularRaysConstants {
  float max_roughness;
  std::uint32_t by_plan;  // 0: every pixel is sampled
};
struct SpecularRaysJob : FrameJob<SpecularRaysBindings, SpecularRaysConstants> {
  bool layered;  // materials of the scene have layers
  LobeTables tables;
  const Environment& environment;
  Rows rows;  // of cells, whose rays are made
};
void specular_rays(const SpecularRaysJob& job);

/// shaders/reflections/specular_shade.comp
template <class Stage>
struct SpecularShadeBindings {
  gpu::Read<Stage> surface;  // rgba8
  gpu::Read<Stage> motion;   // rgba32f
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  RaySink<Stage> shadows;      // toward lights
  gpu::Write<Stage> radiance;  // rgba32f
  // One frame ago, or anything:
  gpu::Read<Stage> previous_motion;    // rgba32f
  gpu::Read<Stage> previous_instance;  // r32ui
  gpu::Read<Stage> visibility;         // rgba16
  // With indirect diffuse light:
  gpu::OptionalReadWriteBuffer<Stage, std::uint32_t> cache_keys;
  gpu::OptionalReadWriteBuffer<Stage, shared::RadianceCell> cache_cells;
};
struct SpecularShadeConstants {
  std::uint32_t lights;         // 0: only the environment lights what is hit
  std::int32_t scale;           // pixels to a texel of `radiance`
  std::uint32_t reuse_shadows;  // of the frame before
  std::uint32_t cached_lights;  // 1: rough surfaces reflect the cache's light of lights
  shared::RadianceCacheConstants cache;
};
struct SpecularShadeJob : FrameJob<SpecularShadeBindings, SpecularShadeConstants> {
  bool layered;  // as above
  SceneView scene;
  const Environment& environment;
  SceneLights lights;
  LobeTables tables;
};
void specular_shade(const SpecularShadeJob& job);

/// shaders/reflections/specular_resolve.comp: adds the light of shadow rays that are not occluded.
template <class Stage>
struct SpecularResolveBindings {
  RaySource<Stage> shadows;
  gpu::ReadBuffer<Stage, std::uint32_t> occluded;
  gpu::ReadWrite<Stage> radiance;  // rgba32f
};
struct SpecularResolveConstants {
  std::int32_t scale;  // pixels to a texel of `radiance`
};
using SpecularResolveJob = gpu::HostPass<SpecularResolveBindings, SpecularResolveConstants>;
void specular_resolve(const SpecularResolveJob& job);

}  // namespace heliograph::render::kernels
