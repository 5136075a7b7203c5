#include "scene/animation/explosion.hpp"

#include <algorithm>

namespace heliograph::scene {

Bounds posed_bounds(const Scene& scene, const Pose& pose) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    const Bounds own = world_bounds(scene.meshes[instance.mesh].bounds, pose.worlds[instance.node]);
    if (!own.empty()) bounds.include(own);
  }
  return bounds;
}

Explosion::Explosion(const Scene& scene)
    : scene_(scene), has_meshes_(scene.nodes.size()), offsets_(scene.nodes.size()) {
  std::vector<Bounds> assemblies(scene.nodes.size());
  Bounds all;
  for (const Instance& instance : scene.instances) {
    const Bounds own =
        world_bounds(scene.meshes[instance.mesh].bounds, scene.nodes[instance.node].world);
    lowest_.push_back(own.minimum.y);
    has_meshes_[instance.node] = true;
    if (own.empty()) continue;
    assemblies[instance.node].include(own);
    all.include(own);
  }
  // Parents come before their children.
  for (std::size_t i = scene.nodes.size(); i-- > 0;) {
    const auto parent = scene.nodes[i].parent;
    if (parent && !assemblies[i].empty()) assemblies[*parent].include(assemblies[i]);
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (assemblies[i].empty()) continue;
    const auto parent = scene.nodes[i].parent;
    const Bounds& around = parent ? assemblies[*parent] : all;
    offsets_[i] = assemblies[i].center() - around.center();
    if (parent) offsets_[i] += offsets_[*parent];
  }
}

float Explosion::lift(float amount) const {
  float assembled = 1e30f, exploded = 1e30f;
  for (std::size_t i = 0; i < lowest_.size(); ++i) {
    assembled = std::min(assembled, lowest_[i]);
    exploded = std::min(exploded, lowest_[i] + amount * offsets_[scene_.instances[i].node].y);
  }
  return std::max(assembled - exploded, 0.0f);
}

void Explosion::apply(float amount, Pose& pose) const {
  if (amount == 0.0f) return;
  const glm::vec3 up(0.0f, lift(amount), 0.0f);
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    if (has_meshes_[i]) pose.worlds[i][3] += glm::vec4(amount * offsets_[i] + up, 0.0f);
  }
}

Pose shown_pose(const Scene& scene, const Clip* clip, double seconds, float amount) {
  Pose pose = pose_at(scene, clip, seconds);
  if (amount > 0.0f) Explosion(scene).apply(amount, pose);
  return pose;
}

Bounds exploded_bounds(const Scene& scene, float amount) {
  if (amount == 0.0f) return scene.bounds;
  return posed_bounds(scene, shown_pose(scene, nullptr, 0.0, amount));
}

}  // namespace heliograph::scene
