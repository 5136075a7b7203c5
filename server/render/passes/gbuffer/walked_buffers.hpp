#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "gpu/frame_plan/frame_plan.hpp"
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

}  // namespace heliograph::render
