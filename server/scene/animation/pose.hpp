#pragma once

#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// Node transforms and morph weights at one time.
struct Pose {
  std::vector<glm::mat4> worlds;            // node -> world, by node
  std::vector<std::vector<float>> weights;  // of morph targets, by node
};

/// The pose that the file's node transforms define.
Pose rest_pose(const Scene& scene);

/// The clip of this name, or null.
const Clip* find_clip(const Scene& scene, std::string_view name);

/// Sets `pose`, which belongs to the same scene, to `clip` at `seconds`. Nodes that the clip does
/// not animate take their default pose. Clips loop: times beyond the end wrap around.
void evaluate(const Scene& scene, const Clip& clip, double seconds, Pose& pose);

/// That of `clip` at `seconds`; without a clip the file's.
Pose pose_at(const Scene& scene, const Clip* clip, double seconds);

/// The moment that `clip` shows at `seconds`, from 0 to its duration: clips loop.
float moment_of(const Clip& clip, double seconds);

/// A camera of the scene in `clip`, or as in the file, at `seconds`: clips move cameras with their
/// nodes, and change their lenses.
Camera camera_at(const Scene& scene, const Camera& camera, const Clip* clip, double seconds);

/// By node: whether some clip may change its world matrix. All others stay as the file has them.
std::vector<bool> movable_nodes(const Scene& scene);

/// Whether a clip moves a camera of the scene or changes its lens.
bool carries(const Scene& scene, const Clip& clip, const Camera& camera);

/// The value of a curve at `seconds`, `curve.width` numbers (glTF 2.0, appendix C), clamped to the
/// first and last key.
void sample(const Curve& curve, float seconds, float* value);
/// The same of a channel; rotations go along the shorter arc and are normalized.
void sample(const Channel& channel, float seconds, float* value);

}  // namespace heliograph::scene
