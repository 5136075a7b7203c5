#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>

#include "gpu/frame_plan/frame_plan.hpp"
#include "tracing/bvh/bvh.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// Refits the trees of deforming meshes on the device, in the tables that rays are traced through:
/// corners of triangles, then boxes from the leaves up. Trees keep their shape.
class DeviceRefit {
 public:
  struct Programs {
    gpu::ComputeProgram corners;
    gpu::ComputeProgram boxes;
    explicit Programs(const gpu::Device& device);
  };
  /// A copy of the static hierarchy's, as storage buffers.
  struct Tables {
    const gpu::Buffer& records;    // shared::BvhNode
    const gpu::Buffer& triangles;  // Bvh::triangles
  };

  /// `programs` and `tables` outlive this; `scene`: that of the static hierarchy. Keeps no
  /// reference to it.
  DeviceRefit(const gpu::Device& device, const Programs& programs, const Bvh& rest,
              const scene::Scene& scene, const Tables& tables);

  /// Takes the vertices of a mesh; of one that does not deform, nothing.
  void move(const Movement::Mesh& mesh);
  /// Brings all trees to the vertices taken. Waits for the device.
  void run();

 private:
  void refit_corners(const gpu::ComputeProgram& program, gpu::BufferRef triangles);
  void refit_boxes(const gpu::ComputeProgram& program, gpu::BufferRef triangles,
                   gpu::BufferRef records, std::span<const std::uint32_t> first_node);

  std::map<std::uint32_t, std::size_t> first_position_;  // by mesh that deforms
  std::uint32_t triangle_count_ = 0;
  gpu::Buffer positions_;  // three floats for each vertex
  gpu::Buffer triangles_;  // shared::RefitTriangle
  gpu::Buffer nodes_;      // records, a uint each, by level
  gpu::Buffer levels_;     // the first of each level in nodes_, then their number
  gpu::FramePlan plan_;
};

}  // namespace heliograph::tracing
