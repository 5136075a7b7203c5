#include "tracing/flat_instances.hpp"

#include <algorithm>
#include <numeric>

#include "scene/animation/pose.hpp"

namespace heliograph::tracing {

std::vector<bool> flat_instances(const scene::Scene& scene, std::uint64_t most_bytes) {
  const std::vector<bool> moves = scene::movable_nodes(scene);
  std::vector<bool> deforms(scene.meshes.size());
  for (const scene::Deformation& deformation : scene.deformations) deforms[deformation.mesh] = true;

  std::vector<bool> flat;
  std::vector<std::uint64_t> flat_count(scene.meshes.size());
  std::vector<bool> instanced(scene.meshes.size());
  for (const auto& [mesh, node] : scene.instances) {
    flat.push_back(!moves[node] && !deforms[mesh]);
    if (flat.back()) ++flat_count[mesh];
    if (!flat.back()) instanced[mesh] = true;
  }

  // The first flat instance of a mesh replaces the mesh's own scene, unless others need that.
  std::vector<std::uint64_t> copied(scene.meshes.size());
  for (std::size_t i = 0; i < copied.size(); ++i) {
    const std::uint64_t copies = flat_count[i] - (flat_count[i] > 0 && !instanced[i] ? 1 : 0);
    copied[i] = copies * (scene.meshes[i].indices.size() / 3) * flat_triangle_bytes;
  }
  std::uint64_t sum = std::accumulate(copied.begin(), copied.end(), std::uint64_t{0});
  std::vector<std::size_t> order(copied.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return copied[i]; });
  std::vector<bool> left(copied.size());
  for (const std::size_t mesh : order) {
    if (sum <= most_bytes) break;
    sum -= copied[mesh];
    left[mesh] = true;
  }
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (left[scene.instances[i].mesh]) flat[i] = false;
  }
  return flat;
}

}  // namespace heliograph::tracing
