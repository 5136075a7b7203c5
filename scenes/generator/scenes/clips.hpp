#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/gltf/document.hpp"

namespace heliograph::scenes {

inline constexpr float loop_seconds = 10.0f;

struct Pose {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
};

/// Keys of `pose(phase)`, phase in [0, 1], for one node: a loop of ten seconds that closes exactly.
/// A rotation that never changes, and a translation that never does, get no channel.
void animate(Animation& animation, int node, const std::function<Pose(float phase)>& pose);

/// A camera at `eye` that looks at `target`.
Pose look(glm::vec3 eye, glm::vec3 target);

/// Turns the sun to both sides of its azimuth and back, `swing` degrees each way.
void swing_sun(Document& document, Animation& animation, float elevation, float azimuth,
               float swing);

/// The node of that name. @throws std::invalid_argument
int find_node(const Document& document, const std::string& name);

/// 0 at the ends of the loop, 1 in its middle, smooth.
float there_and_back(float phase);

}  // namespace heliograph::scenes
