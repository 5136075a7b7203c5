#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/scene.hpp"
#include "shaders/shared/bvh.h"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {

/// One level of a hierarchy: a binary tree over boxes, flattened depth first. Links in `nodes` are
/// relative to its first node.
struct Hierarchy {
  std::vector<shared::BvhNode> nodes;
  std::uint32_t root = shared::bvh_no_link;
  std::uint32_t depth = 0;  // maximum stack depth of traversal
};

/// @throws std::length_error when there are more triangles than links can address
std::uint32_t leaf_link(std::size_t first, std::size_t count);

/// Called once per leaf, in depth-first order, with indices into `boxes`; returns the leaf's link.
using LeafWriter = std::function<std::uint32_t(std::span<const std::uint32_t> items)>;

/// The parts of item `item` on both sides of `at` along `axis`, each within `box`.
using ItemSplitter = std::function<std::array<scene::Bounds, 2>(
    std::uint32_t item, const scene::Bounds& box, int axis, float at)>;

/// Surface area heuristic, binned (Wald 2007), by Embree's builder. Boxes that are empty or not
/// finite are left out. At most `leaf_size` (<= 8) items share a leaf. Thread safe.
/// With `split`, large items may lie in several leaves (spatial splits; Stich et al. 2009).
/// @throws std::runtime_error when the tree is too deep for the traversal stack;
/// scene::LoadCancelled soon after `stop` was requested
Hierarchy build_hierarchy(RTCDevice device, std::span<const scene::Bounds> boxes,
                          std::uint32_t leaf_size, const LeafWriter& write_leaf,
                          const std::stop_token& stop = {}, const ItemSplitter& split = {});

}  // namespace heliograph::tracing
