#include "session/inspection/anchors.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "session/library/scene_description.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

constexpr float sum_tolerance = 1e-3f;

std::uint32_t triangles_of(const scene::Scene& scene, std::uint32_t instance) {
  return static_cast<std::uint32_t>(scene.meshes[scene.instances[instance].mesh].indices.size() /
                                    3);
}

}  // namespace

Result<scene::SurfaceAnchor> to_anchor(const scene::Scene& scene,
                                       const protocol::SurfaceAnchor& request,
                                       const std::string& path) {
  if (request.node >= scene.nodes.size()) {
    const std::size_t count = scene.nodes.size();
    return error::invalid(path + ".node", "the scene has no such node",
                          count > 0 ? "0.." + std::to_string(count - 1) : "no nodes");
  }
  const auto& [x, y, z] = request.barycentrics;
  const float sum = x + y + z;
  if (!(std::abs(sum - 1.0f) <= sum_tolerance)) {
    return error::invalid(path + ".barycentrics", "must add up to 1");
  }
  const std::vector<std::uint32_t> node_of = nodes_of_instances(scene);
  std::uint32_t before = 0;  // triangles of the node's meshes so far
  for (std::uint32_t i = 0; i < node_of.size(); ++i) {
    if (node_of[i] != request.node) continue;
    const std::uint32_t count = triangles_of(scene, i);
    if (request.triangle - before < count) {
      return scene::SurfaceAnchor{.instance = i,
                                  .triangle = request.triangle - before,
                                  .barycentrics = glm::vec3(x, y, z) / sum};
    }
    before += count;
  }
  if (before == 0) return error::invalid(path + ".node", "has no mesh");
  return error::invalid(path + ".triangle", "the node has no such triangle",
                        "0.." + std::to_string(before - 1));
}

protocol::SurfaceAnchor to_protocol(const scene::Scene& scene, const scene::SurfaceAnchor& anchor) {
  const std::vector<std::uint32_t> node_of = nodes_of_instances(scene);
  const std::uint32_t node = node_of[anchor.instance];
  std::uint32_t before = 0;
  for (std::uint32_t i = 0; i < anchor.instance; ++i) {
    if (node_of[i] == node) before += triangles_of(scene, i);
  }
  return {.node = node,
          .triangle = before + anchor.triangle,
          .barycentrics = to_protocol(anchor.barycentrics)};
}

}  // namespace heliograph::session
