#include "tracing/bvh/bvh.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "scene/first_failure.hpp"
#include "tracing/bvh/alpha_mask.hpp"
#include "tracing/bvh/hierarchy.hpp"
#include "tracing/flat_instances.hpp"

namespace heliograph::tracing {
namespace {

static_assert(sizeof(shared::BvhNode) == 64 && sizeof(shared::BvhInstance) == 64);
static_assert(sizeof(shared::BvhMask) == 64 && sizeof(shared::BvhTriangle) == 48);

/// The subtree of a mesh, or of all flat instances.
struct TriangleTree {
  Hierarchy hierarchy;
  std::vector<shared::BvhTriangle> triangles;  // leaf order
};

using Corners = std::array<glm::vec3, 3>;

std::uint32_t number(std::size_t value) {
  if (value > shared::bvh_number_mask) throw std::length_error("the scene is too large to trace");
  return shared::bvh_number_tag | static_cast<std::uint32_t>(value);
}

Corners corners(const scene::Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](std::size_t i) {
    return mesh.vertices[mesh.indices[3 * triangle + i]].position;
  };
  return {corner(0), corner(1), corner(2)};
}

/// Triangles with a non-finite vertex get empty boxes.
scene::Bounds triangle_box(const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  if (!std::isfinite(glm::dot(a, a) + glm::dot(b, b) + glm::dot(c, c))) return {};
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

TriangleTree build_mesh(RTCDevice device, const scene::Mesh& mesh, const std::stop_token& stop) {
  constexpr std::uint32_t triangles_per_leaf = 4;
  TriangleTree result;
  std::vector<scene::Bounds> boxes(mesh.indices.size() / 3);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = triangle_box(corners(mesh, i));
  result.triangles.reserve(boxes.size());
  const auto write_leaf = [&](std::span<const std::uint32_t> items) {
    const std::uint32_t link = leaf_link(result.triangles.size(), items.size());
    for (const std::uint32_t item : items) {
      const auto [a, b, c] = corners(mesh, item);
      result.triangles.push_back({a, number(item), b, 0, c, 0});
    }
    return link;
  };
  result.hierarchy = build_hierarchy(device, boxes, triangles_per_leaf, write_leaf, stop);
  return result;
}

/// Whether the camera sees the instance's triangles only from where their corners appear
/// counter-clockwise in the world. False is always safe: so it is where a mirror turns them.
bool is_one_sided(const shared::Material& material, const glm::mat4& world) {
  const bool double_sided = (material.flags & shared::material_double_sided) != 0;
  return !double_sided && glm::determinant(glm::mat3(world)) > 0.0f;
}

/// Whether a triangle's rounded places in the world have the normal that shaders find from its
/// places in the mesh: bvh_normal_error.
bool keeps_normal(const Corners& in_mesh, const Corners& in_world, const glm::mat3& world) {
  const auto& [a, b, c] = in_mesh;
  const glm::vec3 exact = glm::cross(world * (b - a), world * (c - a));
  const glm::vec3 rounded = glm::cross(in_world[1] - in_world[0], in_world[2] - in_world[0]);
  return glm::distance(glm::normalize(exact), glm::normalize(rounded)) < shared::bvh_normal_error;
}

/// The triangles of flat instances, in world space.
std::vector<shared::BvhTriangle> flat_triangles(const scene::Scene& scene, const Bvh& bvh) {
  std::vector<shared::BvhTriangle> triangles;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const BvhMesh& traced = bvh.meshes[scene.instances[i].mesh];
    const glm::mat4& world = scene.nodes[scene.instances[i].node].world;
    if (!bvh.flat[i] || bvh.hidden[i] || !traced.covers || !traceable_inverse(world)) continue;
    const bool one_sided = is_one_sided(scene.materials[mesh.material], world);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const Corners in_mesh = corners(mesh, t);
      Corners at;
      std::ranges::transform(in_mesh, at.begin(), [&](const glm::vec3& corner) {
        return glm::vec3(world * glm::vec4(corner, 1.0f));
      });
      std::uint32_t instance = number(i);
      if (one_sided && keeps_normal(in_mesh, at, glm::mat3(world))) {
        instance |= shared::bvh_one_sided_bit;
      }
      triangles.push_back({at[0], number(t), at[1], instance, at[2], traced.mask});
    }
  }
  return triangles;
}

/// The part of a triangle on one side of `at`, which lies within `box`.
scene::Bounds part_of(const Corners& triangle, const scene::Bounds& box, int axis, float at,
                      bool above) {
  const auto outside = [&](float c) { return above ? c < at : c > at; };
  scene::Bounds part;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& from = triangle[static_cast<std::size_t>(i)];
    const glm::vec3& to = triangle[static_cast<std::size_t>((i + 1) % 3)];
    if (!outside(from[axis])) part.include(from);
    if (outside(from[axis]) == outside(to[axis])) continue;
    glm::vec3 cut = glm::mix(from, to, (at - from[axis]) / (to[axis] - from[axis]));
    cut[axis] = at;
    part.include(cut);
  }
  if (part.minimum.x > part.maximum.x) {
    part = box;
    (above ? part.minimum : part.maximum)[axis] = at;
    return part;
  }
  // Widened for rounding of the cuts.
  const glm::vec3 slack = 4e-7f * glm::max(glm::abs(box.minimum), glm::abs(box.maximum));
  return {glm::max(part.minimum - slack, box.minimum), glm::min(part.maximum + slack, box.maximum)};
}

/// Of all flat instances. A spatial split costs build time and memory that pays in large trees.
TriangleTree build_flat(RTCDevice device, const std::vector<shared::BvhTriangle>& triangles,
                        const std::stop_token& stop) {
  constexpr std::uint32_t triangles_per_leaf = 4;
  TriangleTree result;
  std::vector<scene::Bounds> boxes;
  boxes.reserve(triangles.size());
  for (const auto& t : triangles) boxes.push_back(triangle_box({t.corner0, t.corner1, t.corner2}));
  result.triangles.reserve(boxes.size() + boxes.size() / 2);
  std::vector<bool> written(triangles.size());
  const auto write_leaf = [&](std::span<const std::uint32_t> items) {
    const std::uint32_t link = leaf_link(result.triangles.size(), items.size());
    for (const std::uint32_t item : items) {
      result.triangles.push_back(triangles[item]);
      if (written[item]) result.triangles.back().triangle |= shared::bvh_again_bit;
      written[item] = true;
    }
    return link;
  };
  const auto split = [&](std::uint32_t item, const scene::Bounds& box, int axis, float at) {
    const shared::BvhTriangle& t = triangles[item];
    const Corners cut{t.corner0, t.corner1, t.corner2};
    return std::array{part_of(cut, box, axis, at, false), part_of(cut, box, axis, at, true)};
  };
  result.hierarchy = build_hierarchy(device, boxes, triangles_per_leaf, write_leaf, stop, split);
  return result;
}

std::uint32_t moved_link(std::uint32_t link, std::size_t records, std::size_t triangles) {
  if (link & shared::bvh_leaf_bit) {
    const std::uint32_t count =
        (link >> shared::bvh_leaf_count_shift) & shared::bvh_leaf_count_mask;
    return leaf_link((link & shared::bvh_leaf_first_mask) + triangles, count + 1);
  }
  return number((link & shared::bvh_number_mask) + records);
}

template <typename Record>
std::size_t append_record(Bvh& bvh, const Record& record) {
  bvh.records.push_back(std::bit_cast<shared::BvhNode>(record));
  return bvh.records.size() - 1;
}

/// The mask of a mesh, and the uvs of its triangles. @return the number of its record
std::uint32_t append_mask(Bvh& bvh, const AlphaMask& mask) {
  const std::size_t first_uv = bvh.triangles.size();
  for (std::size_t i = 0; i < mask.uvs.size(); i += 3) {
    bvh.triangles.emplace_back(mask.uvs[i], mask.uvs[i + 1]);
    bvh.triangles.emplace_back(mask.uvs[i + 2], 0.0f, 0.0f);
  }
  bvh.masked = true;
  return number(append_record(bvh, shared::BvhMask{number(mask.texels),
                                                   number(mask.width),
                                                   number(mask.height),
                                                   number(mask.limit),
                                                   number(mask.wrap_s),
                                                   number(mask.wrap_t),
                                                   number(first_uv),
                                                   {}}));
}

/// What rays need of every mesh apart from its tree.
void append_masks(Bvh& bvh, const scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes) {
    const shared::Material& material = scene.materials[mesh.material];
    const Coverage seen = coverage(material);
    BvhMesh& made = bvh.meshes.emplace_back();
    made.covers = seen != Coverage::none;
    if (seen == Coverage::masked) made.mask = append_mask(bvh, make_alpha_mask(mesh, material));
  }
  // Triangles begin at a whole number of their own size.
  while (bvh.triangles.size() % shared::bvh_texels_per_triangle != 0) bvh.triangles.emplace_back();
}

void append_tree(Bvh& bvh, const TriangleTree& tree, BvhMesh& placed) {
  if (tree.hierarchy.root == shared::bvh_no_link) return;
  const std::size_t first_record = placed.first_record = bvh.records.size();
  const std::size_t first_triangle = placed.first_triangle =
      bvh.triangles.size() / shared::bvh_texels_per_triangle;
  placed.nodes = tree.hierarchy.nodes.size();
  placed.triangles = tree.triangles.size();
  placed.root = moved_link(tree.hierarchy.root, first_record, first_triangle);
  for (shared::BvhNode node : tree.hierarchy.nodes) {
    node.left = moved_link(node.left, first_record, first_triangle);
    node.right = moved_link(node.right, first_record, first_triangle);
    bvh.records.push_back(node);
  }
  for (const shared::BvhTriangle& triangle : tree.triangles) {
    for (const glm::vec4& texel : std::bit_cast<std::array<glm::vec4, 3>>(triangle)) {
      bvh.triangles.push_back(texel);
    }
  }
  bvh.mesh_depth = std::max(bvh.mesh_depth, tree.hierarchy.depth);
}

void append_meshes(Bvh& bvh, const std::vector<TriangleTree>& trees) {
  std::size_t records = bvh.records.size();
  std::size_t texels = bvh.triangles.size();
  for (const TriangleTree& tree : trees) {
    records += tree.hierarchy.nodes.size();
    texels += tree.triangles.size() * shared::bvh_texels_per_triangle;
  }
  bvh.records.reserve(records);
  bvh.triangles.reserve(texels);
  for (std::size_t i = 0; i < trees.size(); ++i) append_tree(bvh, trees[i], bvh.meshes[i]);
}

void append_flat(RTCDevice device, Bvh& bvh, const scene::Scene& scene,
                 const std::stop_token& stop) {
  const std::vector<shared::BvhTriangle> triangles = flat_triangles(scene, bvh);
  for (const auto& t : triangles) {
    const scene::Bounds box = triangle_box({t.corner0, t.corner1, t.corner2});
    if (box.minimum.x > box.maximum.x) continue;
    bvh.flat_bounds.include(box);
  }
  append_tree(bvh, build_flat(device, triangles, stop), bvh.flat_tree);
}

/// The instance whose mesh is the flat tree.
shared::BvhInstance flat_instance(const Bvh& bvh) {
  const glm::mat4 rows(1.0f);
  return {rows[0], rows[1], rows[2], bvh.flat_tree.root, number(0), shared::bvh_no_link, number(1)};
}

scene::Bounds world_box(const scene::Bounds& box, const glm::mat4& world) {
  scene::Bounds result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point(corner & 1 ? box.maximum.x : box.minimum.x,
                          corner & 2 ? box.maximum.y : box.minimum.y,
                          corner & 4 ? box.maximum.z : box.minimum.z);
    result.include(glm::vec3(world * glm::vec4(point, 1.0f)));
  }
  // Boxes are tested in world space, triangles in mesh space: widened for rounding between them.
  const glm::vec3 largest = glm::max(glm::abs(result.minimum), glm::abs(result.maximum));
  const float slack = 4e-7f * (largest.x + largest.y + largest.z);
  return {result.minimum - slack, result.maximum + slack};
}

}  // namespace

std::optional<glm::mat4> traceable_inverse(const glm::mat4& world) {
  const glm::mat4 inverse = glm::inverse(world);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(inverse[column][row])) return std::nullopt;
    }
  }
  return inverse;
}

BvhTopLevel build_top_level(RTCDevice device, const Bvh& bvh,
                            std::span<const std::uint32_t> mesh_of,
                            std::span<const glm::mat4> worlds,
                            std::span<const scene::Bounds> bounds) {
  BvhTopLevel top;
  std::vector<scene::Bounds> boxes;
  std::vector<std::uint32_t> records;
  const auto place = [&](const scene::Bounds& box, const shared::BvhInstance& instance) {
    boxes.push_back(box);
    records.push_back(static_cast<std::uint32_t>(bvh.first_placed + top.records.size()));
    top.records.push_back(std::bit_cast<shared::BvhNode>(instance));
  };
  if (bvh.flat_tree.root != shared::bvh_no_link) place(bvh.flat_bounds, flat_instance(bvh));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const BvhMesh& mesh = bvh.meshes[mesh_of[i]];
    const auto inverse = traceable_inverse(worlds[i]);
    if (bvh.flat[i] || bvh.hidden[i] || mesh.root == shared::bvh_no_link || !inverse) continue;
    const glm::mat4 rows = glm::transpose(*inverse);
    place(world_box(bounds[mesh_of[i]], worlds[i]),
          {rows[0], rows[1], rows[2], mesh.root, number(i), mesh.mask, number(0)});
  }
  const Hierarchy tree = build_hierarchy(
      device, boxes, 1, [&](auto items) { return leaf_link(records[items[0]], 1); });
  if (tree.root == shared::bvh_no_link) return {};
  const std::size_t first = bvh.first_placed + top.records.size();
  for (shared::BvhNode node : tree.nodes) {
    node.left = moved_link(node.left, first, 0);
    node.right = moved_link(node.right, first, 0);
    top.records.push_back(node);
  }
  top.nodes = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(tree.nodes.size())};
  top.root = moved_link(tree.root, first, 0);
  // In addition to both trees: the link that leaves the mesh, and the bottom of the stack.
  top.depth = bvh.mesh_depth + tree.depth + 2;
  if (top.depth > shared::bvh_stack_size) {
    throw std::length_error("the scene's hierarchy is " + std::to_string(top.depth) +
                            " levels deep, the limit is " + std::to_string(shared::bvh_stack_size));
  }
  return top;
}

Bvh build_bvh(RTCDevice device, const scene::Scene& scene, const BvhLayout& layout,
              const std::stop_token& stop) {
  Bvh bvh;
  bvh.is_flat = layout.flat;
  bvh.flat = layout.flat ? flat_instances(scene, layout.most_bytes)
                         : std::vector<bool>(scene.instances.size());
  bvh.hidden = layout.hidden;
  bvh.hidden.resize(scene.instances.size());
  append_masks(bvh, scene);
  std::vector<bool> instanced(scene.meshes.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!bvh.flat[i]) instanced[scene.instances[i].mesh] = true;
  }
  std::vector<TriangleTree> trees(scene.meshes.size());
  scene::FirstFailure failure;
  tbb::parallel_for(std::size_t(0), trees.size(), [&](std::size_t i) {
    if (!instanced[i] || !bvh.meshes[i].covers) return;
    failure.guard([&] { trees[i] = build_mesh(device, scene.meshes[i], stop); });
  });
  failure.rethrow();
  append_meshes(bvh, trees);
  append_flat(device, bvh, scene, stop);
  bvh.first_placed = bvh.records.size();
  std::vector<std::uint32_t> mesh_of;
  std::vector<glm::mat4> worlds;
  for (const scene::Instance& instance : scene.instances) {
    mesh_of.push_back(instance.mesh);
    worlds.push_back(scene.nodes[instance.node].world);
  }
  std::vector<scene::Bounds> bounds;
  for (const scene::Mesh& mesh : scene.meshes) bounds.push_back(mesh.bounds);
  const BvhTopLevel top = build_top_level(device, bvh, mesh_of, worlds, bounds);
  bvh.records.insert(bvh.records.end(), top.records.begin(), top.records.end());
  bvh.upper_nodes = top.nodes;
  bvh.root = top.root;
  bvh.depth = top.depth;
  return bvh;
}

}  // namespace heliograph::tracing
