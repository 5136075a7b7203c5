#include "scenes/generator/scenes/clips.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace heliograph::scenes {
namespace {

constexpr int keys_per_loop = 60;

}  // namespace

void animate(Animation& animation, int node, const std::function<Pose(float)>& pose) {
  Channel move;
  Channel turn;
  move.node = turn.node = node;
  move.path = Channel::Path::translation;
  turn.path = Channel::Path::rotation;
  const Pose start = pose(0.0f);
  bool moves = false;
  bool turns = false;
  glm::quat previous = start.rotation;
  for (int key = 0; key <= keys_per_loop; ++key) {
    // The last key is the first one again: the loop closes exactly.
    const Pose now = pose(float(key % keys_per_loop) / float(keys_per_loop));
    // Of the two quaternions for one rotation the nearer one: no detour between keys.
    const glm::quat near = glm::dot(now.rotation, previous) < 0.0f ? -now.rotation : now.rotation;
    previous = near;
    moves |= now.translation != start.translation;
    turns |= near != start.rotation;
    move.seconds.push_back(loop_seconds * float(key) / float(keys_per_loop));
    move.values.push_back(glm::vec4(now.translation, 0.0f));
    turn.values.push_back({near.x, near.y, near.z, near.w});
  }
  turn.seconds = move.seconds;
  if (moves) animation.channels.push_back(std::move(move));
  if (turns) animation.channels.push_back(std::move(turn));
}

Pose look(glm::vec3 eye, glm::vec3 target) {
  return {eye, look_rotation(eye, target)};
}

void swing_sun(Document& document, Animation& animation, float elevation, float azimuth,
               float swing) {
  const int sun = find_node(document, "sun");
  const glm::vec3 position = document.nodes[std::size_t(sun)].translation;
  animate(animation, sun, [=](float phase) {
    const float turned = azimuth + swing * std::sin(two_pi * phase);
    return Pose{position, look_rotation(direction_to_sun(elevation, turned), glm::vec3(0.0f))};
  });
}

int find_node(const Document& document, const std::string& name) {
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    if (document.nodes[i].name == name) return int(i);
  }
  throw std::invalid_argument("there is no node " + name);
}

float there_and_back(float phase) {
  return 0.5f - 0.5f * std::cos(two_pi * phase);
}

}  // namespace heliograph::scenes
