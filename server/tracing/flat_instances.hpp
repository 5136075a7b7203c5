#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::tracing {

/// What a triangle takes in a scene of triangles, with its share of vertices and nodes;
/// EmbreeMemory.IsAsEstimated compares.
inline constexpr std::uint64_t flat_triangle_bytes = 80;

/// By instance: whether its triangles go into one scene in world space, where rays find them two to
/// four times as fast as through an instance of their mesh. Instances that a clip may move and
/// meshes that deform do not. Neither do the meshes with the most triangles times copies, as long
/// as all copies of triangles, which instances would share, take more than `most_bytes`.
std::vector<bool> flat_instances(const scene::Scene& scene, std::uint64_t most_bytes);

}  // namespace heliograph::tracing
