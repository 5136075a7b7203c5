#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tracing/bvh/bvh.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// How many records the copy of a hierarchy needs, for any placement of the instances.
inline std::size_t moving_record_count(const Bvh& rest, std::size_t instances) {
  return rest.first_placed + 2 * instances;
}

/// The copy of a two-level hierarchy for an animated scene, whose tree over the instances is
/// rebuilt when they move. DeviceRefit brings the trees of deforming meshes to their vertices.
class MovingBvh {
 public:
  /// The copy's tables. The device reads them: write-only memory.
  struct Tables {
    std::span<shared::BvhNode> records;  // record_count() long
    std::span<glm::vec4>
        triangles;  // as long as those of the static hierarchy; empty when no mesh deforms
  };

  /// `scene`: the scene of the static hierarchy. Keeps no reference to it.
  MovingBvh(RTCDevice device, std::shared_ptr<const Bvh> rest, const scene::Scene& scene);

  std::size_t record_count() const { return moving_record_count(*rest_, mesh_of_.size()); }
  std::uint32_t root() const { return root_; }
  BvhNodes upper_nodes() const { return upper_nodes_; }

  /// Fills the tables with the static hierarchy.
  void start(const Tables& tables);
  /// Of the upper level. @throws std::length_error when the instances nest too deeply
  void update(const Movement& movement, const Tables& tables);

 private:
  void place(std::span<const glm::mat4> worlds, const Tables& tables);

  RTCDevice device_;
  std::shared_ptr<const Bvh> rest_;
  std::vector<std::uint32_t> mesh_of_;  // by instance
  std::vector<scene::Bounds> bounds_;   // by mesh
  std::vector<glm::mat4> rest_worlds_;
  std::uint32_t root_ = shared::bvh_no_link;
  BvhNodes upper_nodes_;
};

}  // namespace heliograph::tracing
