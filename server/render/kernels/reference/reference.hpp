#pragma once

#include <span>

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/environment/environment_table.hpp"
#include "shaders/shared/reference.h"

/// Paths of full global illumination on all processors, in vectors.
namespace heliograph::render::kernels {

/// A pass of the host alone: what shaders/reference/reference_bounce.comp does where there is a
/// ray.
template <class Stage>
struct ReferenceBounceBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadWriteBuffer<Stage, shared::ReferencePath>
      paths;                              // by pixel of `rows`; not read in round 0
  RaySink<Stage> next;                    // where paths go on; begun before
  RaySink<Stage> shadows, sky, emissive;  // they carry what arrives unless they are occluded
  gpu::ReadWrite<Stage> radiance;         // rgba32f
  gpu::ReadBuffer<Stage, float> ground_shade;
};
struct ReferenceBounceJob : FrameJob<ReferenceBounceBindings, shared::ReferenceConstants> {
  LitScene lit_scene;
  std::span<const EnvironmentCell> cells;  // of the environment that lights
  RadianceMap background;                  // what the camera sees behind the scene
  bool samples_emissive;                   // triangles of the scene shine
  bool transmits;                          // surfaces let light pass, which is refracted
  std::uint32_t blending;                  // RayCount::blending of shadows
  Rows rows;                               // that the rays are of
};

/// Clears the radiance that the vertices of paths add to, rgba32f.
template <class Stage>
struct ReferenceBeginBindings {
  gpu::Write<Stage> radiance;
};
void reference_begin(const gpu::HostPass<ReferenceBeginBindings>& job);

/// shaders/reference/reference_lens.comp
template <class Stage>
struct ReferenceLensBindings {
  gpu::ReadBuffer<Stage, shared::RayCount> count;
  gpu::ReadWriteBuffer<Stage, shared::Ray> rays;
};
using ReferenceLensJob = FrameJob<ReferenceLensBindings>;
void reference_lens(const ReferenceLensJob& job);

/// One vertex of every path. A pixel has at most one ray in each stream.
void reference_bounce(const ReferenceBounceJob& job);

}  // namespace heliograph::render::kernels
