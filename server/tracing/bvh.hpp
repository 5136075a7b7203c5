#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "shaders/shared/bvh.h"
#include "tracing/embree.hpp"

namespace heliograph::tracing {

/// A two-level bounding volume hierarchy: a tree over instances whose leaves lead into one tree per
/// mesh. `records` mixes nodes, instances and masks, all of one size, so that one texel buffer
/// holds them; `triangles` is in leaf order, followed by the uvs of masked meshes.
struct Bvh {
  std::vector<shared::BvhNode> records;
  std::vector<glm::vec4> triangles;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // most links that wait on a stack, both levels together
  bool masked = false;      // some mesh lets rays through
};

/// World -> mesh for an instance that rays can meet; none when its matrix has no finite inverse.
std::optional<glm::mat4> traceable_inverse(const glm::mat4& world);

/// @throws std::exception when the scene is too large or nests too deeply
Bvh build_bvh(RTCDevice device, const scene::Scene& scene);

}  // namespace heliograph::tracing
