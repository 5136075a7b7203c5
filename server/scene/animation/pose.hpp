#pragma once

#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// Where everything is at one moment.
struct Pose {
  std::vector<glm::mat4> worlds;            // node -> world, by node
  std::vector<std::vector<float>> weights;  // of morph targets, by node
};

/// The pose in which the file shows its nodes.
Pose rest_pose(const Scene& scene);

/// The clip of this name, or null.
const Clip* find_clip(const Scene& scene, std::string_view name);

/// Brings `pose`, which was made for the same scene, to where `clip` has everything at `seconds`.
/// What the clip does not animate rests. Clips loop: time beyond the end starts over.
void evaluate(const Scene& scene, const Clip& clip, double seconds, Pose& pose);

/// A camera of the scene where the pose has it: clips carry cameras about with their nodes.
Camera camera_at(const Scene& scene, const Camera& camera, const Pose& pose);

/// Whether a clip moves a camera of the scene.
bool carries(const Scene& scene, const Clip& clip, const Camera& camera);

/// The value of a channel at `seconds`, `channel.width` numbers (glTF 2.0, appendix C); before the
/// first key the first value, behind the last the last. Rotations come out with unit length.
void sample(const Channel& channel, float seconds, float* value);

}  // namespace heliograph::scene
