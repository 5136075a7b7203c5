#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"

/// Kernels that copy or average signals: bound by memory, plain loops on all processors.
namespace heliograph::render::kernels {

/// Shadow and ambient visibility side by side: shaders/denoise/visibility_combine.comp.
template <class Stage>
struct CombineBindings {
  gpu::Read<Stage> shadows, ambient;  // r32f
  gpu::Write<Stage> visibility;       // rgba32f
};
using CombineJob = gpu::HostPass<CombineBindings>;
void visibility_combine(const CombineJob& job);

/// The running mean of a static view, and in w the variance of its samples' luminance:
/// shaders/post/accumulate.comp.
template <class Stage>
struct AccumulateBindings {
  gpu::Read<Stage> sample, previous;  // rgba32f
  gpu::Write<Stage> mean;
};
struct AccumulateConstants {
  float weight;  // of the sample; 1 discards the mean
};
using AccumulateJob = gpu::HostPass<AccumulateBindings, AccumulateConstants>;
void accumulate(const AccumulateJob& job);

/// The filtered mean blended into the frame that is kept: shaders/post/hold_mean.comp.
template <class Stage>
struct HoldMeanBindings {
  gpu::Read<Stage> mean;           // rgba16f
  gpu::Read<Stage> mean_weight;    // r32f; not read where all pixels have one
  gpu::ReadWrite<Stage> resolved;  // rgba32f
};
struct HoldMeanConstants {
  glm::uvec2 shown;  // size of all images, pixels
  float weight;      // of `mean` in all pixels; below 0: that of `mean_weight`
};
using HoldMeanJob = gpu::HostPass<HoldMeanBindings, HoldMeanConstants>;
void hold_mean(const HoldMeanJob& job);

/// Scatters the results of a stream of visibility rays to their pixels:
/// shaders/visibility/visibility_resolve.comp.
template <class Stage>
struct VisibilityResolveBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, std::uint32_t> occluded;
  gpu::Write<Stage> visibility;  // r32f, where rays are occluded
};
using VisibilityResolveJob = gpu::HostPass<VisibilityResolveBindings>;
void visibility_resolve(const VisibilityResolveJob& job);

}  // namespace heliograph::render::kernels
