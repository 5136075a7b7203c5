#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "shaders/shared/ground.h"

/// The plane that catches shadows (shaders/shared/ground.h), on all processors.
namespace heliograph::render::kernels {

/// shaders/ground/ground_rays.comp
template <class Stage>
struct GroundRaysBindings {
  gpu::ReadBuffer<Stage, shared::GroundLight> lights;
  RaySink<Stage> rays;
};
using GroundRaysJob = FrameJob<GroundRaysBindings>;
void ground_rays(const GroundRaysJob& job);

/// shaders/ground/ground_gather.comp
template <class Stage>
struct GroundGatherBindings {
  gpu::ReadBuffer<Stage, shared::Ray> rays;
  gpu::ReadBuffer<Stage, std::uint32_t> occluded;
  gpu::ReadWriteBuffer<Stage, shared::GroundTexel> texels;
};
struct GroundGatherConstants {
  float kept;
};
using GroundGatherJob = gpu::HostPass<GroundGatherBindings, GroundGatherConstants>;
void ground_gather(const GroundGatherJob& job);

/// shaders/ground/ground_filter.comp
template <class Stage>
struct GroundFilterBindings {
  gpu::ReadBuffer<Stage, shared::GroundTexel> texels;
  /// Of every texel; not written in frames that find nothing new.
  gpu::ReadWriteBuffer<Stage, float> shade;
};
struct GroundFilterConstants {
  int radius;
};
using GroundFilterJob = gpu::HostPass<GroundFilterBindings, GroundFilterConstants>;
void ground_filter(const GroundFilterJob& job);

/// shaders/ground/ground_shade.comp
template <class Stage>
struct GroundShadeBindings {
  gpu::Read<Stage> motion;  // rgba32f
  gpu::ReadBuffer<Stage, float> shade;
  gpu::ReadWrite<Stage> background;  // rgba32f
};
using GroundShadeJob = FrameJob<GroundShadeBindings>;
void ground_shade(const GroundShadeJob& job);

}  // namespace heliograph::render::kernels
