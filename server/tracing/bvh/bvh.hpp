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

/// The subtree of a mesh within the hierarchy.
struct BvhMesh {
  std::uint32_t root = shared::bvh_no_link;  // bvh_no_link: nothing to hit
  std::uint32_t mask = shared::bvh_no_link;  // number of its mask record
  bool covers = false;                       // false: its material lets all rays pass
  std::size_t first_record = 0;
  std::size_t nodes = 0;
  std::size_t first_triangle = 0;
  std::size_t triangles = 0;
};

/// Some of the records, one after the other.
struct BvhNodes {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// What of a scene is one tree in world space, where rays need no instances.
struct BvhLayout {
  bool flat = true;                       // what no clip can move
  std::uint64_t most_bytes = 256u << 20;  // of copies of triangles: flat_instances()
  std::vector<bool> hidden = {};          // by instance: whether rays miss it; empty: they hit all
};

/// A two-level bounding volume hierarchy: a tree over instances, whose leaves link to one tree per
/// mesh, and one tree of triangles in world space. `records` has nodes, instances and masks of
/// equal size in one texel buffer; `triangles` is in leaf order, behind the uvs of masked meshes.
struct Bvh {
  std::vector<shared::BvhNode> records;
  std::vector<glm::vec4> triangles;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // maximum stack depth of traversal, both levels together
  bool masked = false;      // a mesh has partial coverage
  std::vector<BvhMesh> meshes;
  BvhMesh flat_tree;
  scene::Bounds flat_bounds;     // world
  bool is_flat = true;           // BvhLayout::flat
  std::vector<bool> flat;        // by instance: whether it is in that tree, unless it is hidden
  std::vector<bool> hidden;      // by instance
  std::size_t first_placed = 0;  // index of the first instance record; the rest is the upper level
  BvhNodes upper_nodes;          // behind the instances
  std::uint32_t mesh_depth = 0;  // maximum over the meshes
};

/// The upper level: one record per instance that rays can hit, then the nodes.
struct BvhTopLevel {
  std::vector<shared::BvhNode> records;
  BvhNodes nodes;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // of both levels together
};

/// World -> mesh of an instance; nullopt when its matrix has no finite inverse, so that rays miss
/// it.
std::optional<glm::mat4> traceable_inverse(const glm::mat4& world);

/// `mesh_of` and `worlds`: mesh and mesh -> world of each instance; `bounds`: of each mesh.
/// Rebuilds the records from `first_placed` on of a hierarchy with the meshes of `bvh`.
/// @throws std::length_error when the hierarchy is too deep
BvhTopLevel build_top_level(RTCDevice device, const Bvh& bvh,
                            std::span<const std::uint32_t> mesh_of,
                            std::span<const glm::mat4> worlds,
                            std::span<const scene::Bounds> bounds);

/// @throws std::exception when the scene is too large or its hierarchy too deep;
/// scene::LoadCancelled soon after `stop` was requested
Bvh build_bvh(RTCDevice device, const scene::Scene& scene, const BvhLayout& layout = {},
              const std::stop_token& stop = {});

}  // namespace heliograph::tracing
