#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "render/resources/draw.hpp"
#include "scene/animation/pose.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// What of a scene that moves each renderer has for itself: the table of instances, the vertices of
/// meshes that deform, the draw list, and the acceleration structure.
class MovingParts {
 public:
  /// In the default pose, without a structure. `draws`: those of the scene at rest.
  MovingParts(const gpu::Device& device, const scene::Scene& scene, const std::vector<Draw>& draws);

  const gpu::Buffer& instance_table() const { return instance_table_; }
  /// Empty when no mesh deforms; so is the other.
  const gpu::Buffer& vertex_table() const { return vertex_table_; }
  const gpu::Buffer& previous_table() const { return previous_table_; }
  const std::vector<Draw>& draws() const { return draws_; }
  const tracing::AccelerationStructure& structure() const { return *structure_; }

  /// Takes a structure in the default pose and brings it to the present one.
  void set_structure(std::unique_ptr<tracing::MovingStructure> structure,
                     const scene::Scene& scene);

  /// Goes from pose `before` to `pose`: all of the above.
  /// @return whether any shape is, or was a frame ago, elsewhere
  bool move(const scene::Scene& scene, const scene::Pose& before, const scene::Pose& pose);
  /// Instances with another matrix since the last move().
  const std::vector<std::uint32_t>& placed() const { return placed_; }
  /// Whether the last move() moved nothing.
  bool settled() const;

 private:
  /// A mesh that deforms, on the processor.
  struct Deforming {
    std::vector<shared::Vertex> vertices;  // now
    scene::Bounds bounds;
    std::uint32_t mesh = 0;
    std::size_t first_vertex = 0;     // in the table of all vertices
    std::size_t previous_vertex = 0;  // in the table of vertices one frame ago
    bool moved = false;               // by the last advance
    bool moved_before = false;        // by the one before that
  };

  void make_vertex_tables(const gpu::Device& device, const scene::Scene& scene);
  /// Each brings one kind of thing to `pose`; true when anything is now, or was a frame ago,
  /// elsewhere.
  bool move_instances(const scene::Scene& scene, const scene::Pose& pose);
  bool deform(const scene::Scene& scene, const scene::Pose& before, const scene::Pose& pose);
  void move_draws(const scene::Scene& scene);
  void update_structure();

  std::vector<shared::Instance> instances_;
  std::vector<Draw> draws_;
  std::vector<std::uint32_t> draw_of_;  // by instance
  std::vector<Deforming> deforming_;    // by deformation of the scene
  std::vector<std::uint32_t> moved_;    // instances that the last move changed or brought to rest
  std::vector<std::uint32_t> placed_;   // those of them with a new matrix
  std::vector<glm::mat4> worlds_;       // by instance
  std::vector<scene::Bounds> bounds_;   // by mesh

  gpu::Buffer instance_table_;
  gpu::Buffer vertex_table_;
  gpu::Buffer previous_table_;
  std::unique_ptr<tracing::MovingStructure> structure_;
};

}  // namespace heliograph::render
