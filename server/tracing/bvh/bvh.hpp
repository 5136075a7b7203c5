#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "shaders/shared/bvh.h"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {

/// Where a mesh's own tree lies in the whole.
struct BvhMesh {
  std::uint32_t root = shared::bvh_no_link;  // link; none where rays meet nothing
  std::uint32_t mask = shared::bvh_no_link;  // number of its mask's record
  std::size_t first_record = 0;
  std::size_t nodes = 0;
  std::size_t first_triangle = 0;
  std::size_t triangles = 0;
};

/// A two-level bounding volume hierarchy: a tree over instances whose leaves lead into one tree per
/// mesh. `records` mixes nodes, instances and masks, all of one size, so that one texel buffer
/// holds them; `triangles` is in leaf order, followed by the uvs of masked meshes.
struct Bvh {
  std::vector<shared::BvhNode> records;
  std::vector<glm::vec4> triangles;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // most links that wait on a stack, both levels together
  bool masked = false;      // some mesh lets rays through
  std::vector<BvhMesh> meshes;
  std::size_t first_placed = 0;  // record; instances and the tree over them follow to the end
  std::uint32_t mesh_depth = 0;  // the largest of the meshes' own
};

/// The upper level alone: one record for every instance that rays can meet, then the nodes.
struct BvhTopLevel {
  std::vector<shared::BvhNode> records;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // of both levels together
};

/// World -> mesh for an instance that rays can meet; none when its matrix has no finite inverse.
std::optional<glm::mat4> traceable_inverse(const glm::mat4& world);

/// `mesh_of` and `worlds` tell each instance's mesh and mesh -> world; `bounds` belong to meshes.
/// Fills `first_placed` onward of a hierarchy whose meshes are those of `bvh`.
/// @throws std::length_error when it nests too deeply
BvhTopLevel build_top_level(RTCDevice device, const Bvh& bvh,
                            std::span<const std::uint32_t> mesh_of,
                            std::span<const glm::mat4> worlds,
                            std::span<const scene::Bounds> bounds);

/// @throws std::exception when the scene is too large or nests too deeply
Bvh build_bvh(RTCDevice device, const scene::Scene& scene);

}  // namespace heliograph::tracing
