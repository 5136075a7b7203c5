#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {

/// An exploded view: every part moves away from the middle of the assembly that it belongs to. A
/// node's parts are those at its children, so that assemblies stay together as far as the
/// hierarchy of nodes says, and come apart within themselves.
class Explosion {
 public:
  /// Of the assembled scene, which outlives this.
  explicit Explosion(const Scene& scene);

  /// Moves the nodes that have meshes; others, with cameras and lights, stay. `amount`: distance
  /// over that from the middle; 0: nothing moves. Nothing sinks below the lowest point of the
  /// assembled scene.
  void apply(float amount, Pose& pose) const;

 private:
  float lift(float amount) const;

  const Scene& scene_;
  std::vector<bool> has_meshes_;    // by node
  std::vector<glm::vec3> offsets_;  // by node, metres, of amount 1
  std::vector<float> lowest_;       // by instance: least height, metres
};

/// What a frame shows of `clip` at `seconds` (pose_at()), exploded by `amount`.
Pose shown_pose(const Scene& scene, const Clip* clip, double seconds, float amount);

/// World bounds of what the scene shows in a pose.
Bounds posed_bounds(const Scene& scene, const Pose& pose);

/// The scene's bounds, exploded by `amount`.
Bounds exploded_bounds(const Scene& scene, float amount);

}  // namespace heliograph::scene
