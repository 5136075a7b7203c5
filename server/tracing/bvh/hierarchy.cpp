#include "tracing/bvh/hierarchy.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <string>

#include "scene/import_error.hpp"

namespace heliograph::tracing {
namespace {

std::uint32_t node_link(std::uint32_t index) {
  if (index > shared::bvh_number_mask) throw std::length_error("too many nodes in a hierarchy");
  return shared::bvh_number_tag | index;
}

constexpr std::uint32_t largest_leaf = shared::bvh_leaf_count_mask + 1;

/// A node of Embree's builder: an inner node, or a leaf when `count` is not zero. Allocated by
/// Embree.
struct BuildNode {
  std::uint32_t count = 0;
  std::array<std::uint32_t, largest_leaf> items{};
  std::array<void*, 2> children{};
  std::array<RTCBounds, 2> boxes{};
};

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t count, void*) {
  auto* node =
      new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
  node->count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) node->items[i] = primitives[i].primID;
  return node;
}

void set_children(void* node, void** children, unsigned count, void*) {
  std::copy_n(children, count, static_cast<BuildNode*>(node)->children.begin());
}

void set_boxes(void* node, const RTCBounds** boxes, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) static_cast<BuildNode*>(node)->boxes[i] = *boxes[i];
}

bool traceable(const scene::Bounds& box) {
  constexpr float limit = 1e18f;  // products of two coordinates stay finite
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.minimum[axis] > -limit && box.minimum[axis] <= box.maximum[axis] &&
          box.maximum[axis] < limit)) {
      return false;
    }
  }
  return true;
}

std::vector<RTCBuildPrimitive> to_primitives(std::span<const scene::Bounds> boxes) {
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const scene::Bounds& box = boxes[i];
    if (!traceable(box)) continue;
    primitives.push_back({box.minimum.x, box.minimum.y, box.minimum.z, 0, box.maximum.x,
                          box.maximum.y, box.maximum.z, static_cast<unsigned>(i)});
  }
  return primitives;
}

float half_area(const RTCBounds& box) {
  const float x = box.upper_x - box.lower_x;
  const float y = box.upper_y - box.lower_y;
  const float z = box.upper_z - box.lower_z;
  return x * y + y * z + z * x;
}

class Flattener {
 public:
  Flattener(Hierarchy& hierarchy, const LeafWriter& write_leaf)
      : hierarchy_(hierarchy), write_leaf_(write_leaf) {}

  /// Appends the tree under `node`, which is reached with `stacked` links on the traversal stack.
  std::uint32_t add(const BuildNode& node, std::uint32_t stacked) {
    hierarchy_.depth = std::max(hierarchy_.depth, stacked);
    if (node.count > 0) return write_leaf_({node.items.data(), node.count});
    const auto index = static_cast<std::uint32_t>(hierarchy_.nodes.size());
    // The larger box first: rays that nothing orders, those of shadows and from inside both boxes,
    // meet something there sooner.
    const std::size_t larger = half_area(node.boxes[1]) > half_area(node.boxes[0]) ? 1 : 0;
    const RTCBounds& left = node.boxes[larger];
    const RTCBounds& right = node.boxes[1 - larger];
    hierarchy_.nodes.push_back({{left.lower_x, left.upper_x, left.lower_y, left.upper_y},
                                {right.lower_x, right.upper_x, right.lower_y, right.upper_y},
                                {left.lower_z, left.upper_z, right.lower_z, right.upper_z},
                                0,
                                0,
                                0,
                                0});
    const auto child = [&](std::size_t i) {
      return add(*static_cast<const BuildNode*>(node.children[i]), stacked + 1);
    };
    const std::uint32_t left_link = child(larger);
    const std::uint32_t right_link = child(1 - larger);
    hierarchy_.nodes[index].left = left_link;
    hierarchy_.nodes[index].right = right_link;
    return node_link(index);
  }

 private:
  Hierarchy& hierarchy_;
  const LeafWriter& write_leaf_;
};

scene::Bounds to_bounds(const RTCBuildPrimitive& item) {
  return {{item.lower_x, item.lower_y, item.lower_z}, {item.upper_x, item.upper_y, item.upper_z}};
}

RTCBounds to_embree(const scene::Bounds& box) {
  return {box.minimum.x, box.minimum.y, box.minimum.z, 0,
          box.maximum.x, box.maximum.y, box.maximum.z, 0};
}

/// What Embree's builder hands to its callbacks.
struct BuildContext {
  const ItemSplitter& split;
  const std::stop_token& stop;
};

bool hierarchy_goes_on(void* context, double) {
  return !static_cast<const BuildContext*>(context)->stop.stop_requested();
}

void split_item(const RTCBuildPrimitive* item, unsigned axis, float at, RTCBounds* left,
                RTCBounds* right, void* context) {
  const auto& split = static_cast<const BuildContext*>(context)->split;
  const auto [below, above] = split(item->primID, to_bounds(*item), static_cast<int>(axis), at);
  *left = to_embree(below);
  *right = to_embree(above);
}

/// Lets Embree cut items, of which there may be half as many more.
void allow_splits(RTCBuildArguments& arguments, std::vector<RTCBuildPrimitive>& primitives) {
  primitives.reserve(primitives.size() + primitives.size() / 2);
  arguments.primitives = primitives.data();
  arguments.primitiveArrayCapacity = primitives.capacity();
  arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
  arguments.splitPrimitive = split_item;
}

RTCBuildArguments build_arguments(RTCBVH bvh, std::vector<RTCBuildPrimitive>& primitives,
                                  std::uint32_t leaf_size) {
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = 2;
  // Embree splits by surface area cost down to eight levels above this, then at the median.
  arguments.maxDepth = 56;
  arguments.maxLeafSize = leaf_size;
  arguments.bvh = bvh;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_inner;
  arguments.createLeaf = create_leaf;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_boxes;
  return arguments;
}

}  // namespace

std::uint32_t leaf_link(std::size_t first, std::size_t count) {
  if (first > shared::bvh_leaf_first_mask || count == 0 || count > largest_leaf) {
    throw std::length_error("more than " + std::to_string(shared::bvh_leaf_first_mask + 1) +
                            " triangles cannot be traced");
  }
  return shared::bvh_leaf_bit | shared::bvh_number_tag |
         static_cast<std::uint32_t>(count - 1) << shared::bvh_leaf_count_shift |
         static_cast<std::uint32_t>(first);
}

Hierarchy build_hierarchy(RTCDevice device, std::span<const scene::Bounds> boxes,
                          std::uint32_t leaf_size, const LeafWriter& write_leaf,
                          const std::stop_token& stop, const ItemSplitter& split) {
  Hierarchy hierarchy;
  std::vector<RTCBuildPrimitive> primitives = to_primitives(boxes);
  if (primitives.empty()) return hierarchy;
  const EmbreeHandle<RTCBVH> bvh(rtcNewBVH(device));
  check_embree(device, "prepare a hierarchy");
  RTCBuildArguments arguments = build_arguments(bvh.get(), primitives, leaf_size);
  BuildContext context{split, stop};
  arguments.userPtr = &context;
  arguments.buildProgress = hierarchy_goes_on;
  if (split) allow_splits(arguments, primitives);
  const void* root = rtcBuildBVH(&arguments);
  if (stop.stop_requested()) {
    rtcGetDeviceError(device);  // that it was cancelled
    throw scene::LoadCancelled();
  }
  check_embree(device, "build a hierarchy");
  hierarchy.nodes.reserve(primitives.size());
  hierarchy.root = Flattener(hierarchy, write_leaf).add(*static_cast<const BuildNode*>(root), 0);
  return hierarchy;
}

}  // namespace heliograph::tracing
