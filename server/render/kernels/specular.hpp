#pragma once

#include <optional>
#include <span>

#include "gpu/memory/image.hpp"
#include "render/kernels/ray_sink.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/frame_constants.h"

/// Reflections on all processors, in vectors.
namespace heliograph::render::kernels {

/// The table of scales and biases of F0.
struct SplitSum {
  gpu::HostView texels;  // rg32f
  int size;
};

/// Host kernel of shaders/reflections/specular_rays.comp and specular_rays_half.comp.
struct SpecularRaysJob {
  const shared::FrameConstants& frame;
  SplitSum split_sum;
  float max_roughness;
  gpu::HostView normals;     // rgba32f
  gpu::HostView base_color;  // rgba8
  gpu::HostView surface;     // rgba8
  gpu::HostView motion;      // rgba32f
  RaySink rays;              // begun and ended here
  gpu::HostView radiance;    // rgba32f; cleared
  /// rgba32f, written where one pixel of each 2 x 2 traces.
  std::optional<gpu::HostView> directions;
};
void make_specular_rays(const SpecularRaysJob& job);

/// Host kernel of shaders/reflections/specular_shade.comp, for scenes without area lights.
struct ShadeHitsJob {
  const shared::FrameConstants& frame;
  SceneView scene;
  const Environment& environment;
  std::span<const shared::Light> lights;
  SplitSum split_sum;
  bool with_lights;       // otherwise only the environment lights what is hit
  int scale;              // pixels to a texel of `radiance`
  gpu::HostView surface;  // rgba8
  gpu::HostView motion;   // rgba32f
  RaySource rays;
  const shared::Hit* hits;
  RaySink shadows;         // of punctual lights; begun and ended here
  gpu::HostView radiance;  // rgba32f
};
void shade_hits(const ShadeHitsJob& job);

/// Host kernel of shaders/reflections/specular_resolve.comp: adds what shadow rays carry and
/// nothing stopped.
void resolve_lights(const RaySource& shadows, const std::uint32_t* occluded, int scale,
                    const gpu::HostView& radiance);

}  // namespace heliograph::render::kernels
