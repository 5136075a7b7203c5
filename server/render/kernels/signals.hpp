#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/ray.h"

/// Copies and means of signals: bound by memory bandwidth, plain loops on all
/// processors.
namespace heliograph::render::kernels {

/// Shadow and ambient visibility side by side: shaders/denoise/visibility_combine.comp.
struct CombineJob {
  int width;
  int height;
  gpu::HostView shadows, ambient;  // r32f
  gpu::HostView visibility;        // written, rgba32f
};
void combine_visibility(const CombineJob& job);

/// The running mean of a static view: shaders/post/accumulate.comp.
struct AccumulateJob {
  int width;
  int height;
  float weight;  // of the sample; 1 starts again
  gpu::HostView sample, previous;
  gpu::HostView mean;  // written
};
void accumulate(const AccumulateJob& job);

/// Brings the answers of a stream of visibility rays back:
/// shaders/visibility/visibility_resolve.comp.
struct ResolveJob {
  const shared::RayCount& count;
  const shared::Ray* rays;
  const std::uint32_t* occluded;
  gpu::HostView visibility;  // written where rays are occluded, r32f
};
void resolve_visibility(const ResolveJob& job);

}  // namespace heliograph::render::kernels
