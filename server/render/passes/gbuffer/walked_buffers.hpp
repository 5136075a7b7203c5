#pragma once

#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// What passes bind that walk a hierarchy: the three from BVH_BINDING on of
/// shaders/lib/rays/bvh.glsl.
template <class Stage>
struct WalkedBuffers {
  gpu::ReadBuffer<Stage, glm::vec4> records;
  gpu::ReadBuffer<Stage, glm::vec4> triangles;
  gpu::ReadBuffer<Stage, std::uint32_t> alpha_heap;
};

inline WalkedBuffers<gpu::Declared> walked_buffers(gpu::FramePlan& plan,
                                                   const tracing::WalkedHierarchy& hierarchy) {
  return {.records = plan.import(hierarchy.records),
          .triangles = plan.import(hierarchy.triangles),
          .alpha_heap = plan.import(hierarchy.alpha_heap)};
}

/// shaders/gbuffer/gbuffer_trace.comp
template <class Stage>
struct GBufferTraceBindings {
  WalkedBuffers<Stage> hierarchy;
  gpu::WriteBuffer<Stage, shared::Hit> hits;
};

/// The pass that traces the camera rays of all pixels, without its dispatch: groups of 8 x 8.
inline gpu::PassBuilder trace_camera_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                          const tracing::WalkedHierarchy& hierarchy,
                                          const WalkedBuffers<gpu::Declared>& buffers,
                                          gpu::BufferRef hits) {
  return plan.pass("gbuffer.trace", in.program(shaders::gbuffer_trace))
      .bind<GBufferTraceBindings>({.hierarchy = buffers, .hits = hits})
      .constants(hierarchy.root);
}

}  // namespace heliograph::render
