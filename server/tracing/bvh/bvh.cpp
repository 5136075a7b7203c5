#include "tracing/bvh/bvh.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tracing/bvh/alpha_mask.hpp"
#include "tracing/bvh/hierarchy.hpp"

namespace heliograph::tracing {
namespace {

static_assert(sizeof(shared::BvhNode) == 64 && sizeof(shared::BvhInstance) == 64);
static_assert(sizeof(shared::BvhMask) == 64 && sizeof(shared::BvhTriangle) == 48);

constexpr std::uint32_t triangles_per_leaf = 4;

struct MeshBvh {
  Hierarchy hierarchy;
  std::vector<shared::BvhTriangle> triangles;  // leaf order
  std::optional<AlphaMask> mask;
};

std::uint32_t number(std::size_t value) {
  if (value > shared::bvh_number_mask) throw std::length_error("the scene is too large to trace");
  return shared::bvh_number_tag | static_cast<std::uint32_t>(value);
}

std::array<glm::vec3, 3> corners(const scene::Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](std::size_t i) {
    return mesh.vertices[mesh.indices[3 * triangle + i]].position;
  };
  return {corner(0), corner(1), corner(2)};
}

// Triangles with a non-finite vertex get empty boxes.
std::vector<scene::Bounds> triangle_boxes(const scene::Mesh& mesh) {
  std::vector<scene::Bounds> boxes(mesh.indices.size() / 3);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto [a, b, c] = corners(mesh, i);
    if (!std::isfinite(glm::dot(a, a) + glm::dot(b, b) + glm::dot(c, c))) continue;
    boxes[i] = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
  }
  return boxes;
}

MeshBvh build_mesh(RTCDevice device, const scene::Mesh& mesh, const shared::Material& material) {
  MeshBvh result;
  const Coverage seen = coverage(material);
  if (seen == Coverage::none) return result;
  if (seen == Coverage::masked) result.mask = make_alpha_mask(mesh, material);
  const std::vector<scene::Bounds> boxes = triangle_boxes(mesh);
  result.triangles.reserve(boxes.size());
  const auto write_leaf = [&](std::span<const std::uint32_t> items) {
    const std::uint32_t link = leaf_link(result.triangles.size(), items.size());
    for (const std::uint32_t item : items) {
      const auto [a, b, c] = corners(mesh, item);
      result.triangles.push_back({a, number(item), b, 0, c, 0});
    }
    return link;
  };
  result.hierarchy = build_hierarchy(device, boxes, triangles_per_leaf, write_leaf);
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

BvhMesh append_mesh(Bvh& bvh, const MeshBvh& mesh, std::vector<glm::vec4>& uvs,
                    std::size_t triangle_texels) {
  BvhMesh placed;
  if (mesh.hierarchy.root == shared::bvh_no_link) return placed;
  const std::size_t first_record = placed.first_record = bvh.records.size();
  const std::size_t first_triangle = placed.first_triangle =
      bvh.triangles.size() / shared::bvh_texels_per_triangle;
  placed.nodes = mesh.hierarchy.nodes.size();
  placed.triangles = mesh.triangles.size();
  placed.root = moved_link(mesh.hierarchy.root, first_record, first_triangle);
  for (shared::BvhNode node : mesh.hierarchy.nodes) {
    node.left = moved_link(node.left, first_record, first_triangle);
    node.right = moved_link(node.right, first_record, first_triangle);
    bvh.records.push_back(node);
  }
  for (const shared::BvhTriangle& triangle : mesh.triangles) {
    for (const glm::vec4& texel : std::bit_cast<std::array<glm::vec4, 3>>(triangle)) {
      bvh.triangles.push_back(texel);
    }
  }
  if (!mesh.mask) return placed;
  const AlphaMask& mask = *mesh.mask;
  placed.mask = number(append_record(bvh, shared::BvhMask{number(mask.texels),
                                                          number(mask.width),
                                                          number(mask.height),
                                                          number(mask.limit),
                                                          number(mask.wrap_s),
                                                          number(mask.wrap_t),
                                                          number(triangle_texels + uvs.size()),
                                                          number(first_triangle),
                                                          {}}));
  for (const shared::BvhTriangle& triangle : mesh.triangles) {
    const auto* uv = &mask.uvs[3 * std::size_t(triangle.triangle & shared::bvh_number_mask)];
    uvs.emplace_back(uv[0], uv[1]);
    uvs.emplace_back(uv[2], 0.0f, 0.0f);
  }
  return placed;
}

void append_meshes(Bvh& bvh, const std::vector<MeshBvh>& meshes) {
  std::size_t records = 0;
  std::size_t texels = 0;
  for (const MeshBvh& mesh : meshes) {
    records += mesh.hierarchy.nodes.size() + 1;
    texels += mesh.triangles.size() * shared::bvh_texels_per_triangle;
  }
  bvh.records.reserve(records);
  bvh.triangles.reserve(texels);
  std::vector<glm::vec4> uvs;
  bvh.meshes.reserve(meshes.size());
  for (const MeshBvh& mesh : meshes) {
    bvh.meshes.push_back(append_mesh(bvh, mesh, uvs, texels));
    bvh.mesh_depth = std::max(bvh.mesh_depth, mesh.hierarchy.depth);
  }
  bvh.first_placed = bvh.records.size();
  bvh.triangles.insert(bvh.triangles.end(), uvs.begin(), uvs.end());
  bvh.masked = !uvs.empty();
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
  std::vector<scene::Bounds> boxes(worlds.size());
  std::vector<std::uint32_t> records(worlds.size());
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const BvhMesh& mesh = bvh.meshes[mesh_of[i]];
    const auto inverse = traceable_inverse(worlds[i]);
    if (mesh.root == shared::bvh_no_link || !inverse) continue;
    boxes[i] = world_box(bounds[mesh_of[i]], worlds[i]);
    records[i] = static_cast<std::uint32_t>(bvh.first_placed + top.records.size());
    const glm::mat4 rows = glm::transpose(*inverse);
    top.records.push_back(std::bit_cast<shared::BvhNode>(
        shared::BvhInstance{rows[0], rows[1], rows[2], mesh.root, number(i), mesh.mask, 0}));
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
  top.root = moved_link(tree.root, first, 0);
  // In addition to both trees: the link that leaves the mesh, and the bottom of the stack.
  top.depth = bvh.mesh_depth + tree.depth + 2;
  if (top.depth > shared::bvh_stack_size) {
    throw std::length_error("the scene's hierarchy is " + std::to_string(top.depth) +
                            " levels deep, the limit is " + std::to_string(shared::bvh_stack_size));
  }
  return top;
}

Bvh build_bvh(RTCDevice device, const scene::Scene& scene) {
  std::vector<MeshBvh> meshes(scene.meshes.size());
  tbb::parallel_for(std::size_t(0), meshes.size(), [&](std::size_t i) {
    const scene::Mesh& mesh = scene.meshes[i];
    meshes[i] = build_mesh(device, mesh, scene.materials[mesh.material]);
  });
  Bvh bvh;
  append_meshes(bvh, meshes);
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
  bvh.root = top.root;
  bvh.depth = top.depth;
  return bvh;
}

}  // namespace heliograph::tracing
