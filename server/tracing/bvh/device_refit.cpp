#include "tracing/bvh/device_refit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <vector>

#include "shaders/embedded.hpp"
#include "shaders/shared/refit.h"

namespace heliograph::tracing {
namespace {

constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
// No device starts more groups in a row; the shaders' loops do the rest.
constexpr std::uint32_t most_threads = 64u * 65535u;

/// The trees of deforming meshes as the shaders take them.
struct Lists {
  std::vector<glm::vec3> positions;
  std::vector<shared::RefitTriangle> triangles;
  std::vector<std::vector<std::uint32_t>> levels;  // records of nodes; the first have leaves alone
};

void add_triangles(const Bvh& rest, const BvhMesh& tree, const scene::Mesh& mesh, Lists& lists) {
  const auto first = static_cast<std::uint32_t>(lists.positions.size());
  for (std::size_t slot = tree.first_triangle; slot < tree.first_triangle + tree.triangles;
       ++slot) {
    std::array<glm::vec4, shared::bvh_texels_per_triangle> texels;
    std::copy_n(&rest.triangles[slot * texels.size()], texels.size(), texels.begin());
    const auto triangle = std::bit_cast<shared::BvhTriangle>(texels);
    const std::uint32_t* const corners =
        &mesh.indices[3 * std::size_t(triangle.triangle & shared::bvh_number_mask)];
    lists.triangles.push_back({static_cast<std::uint32_t>(slot), first + corners[0],
                               first + corners[1], first + corners[2]});
  }
}

void add_nodes(const Bvh& rest, const BvhMesh& tree, Lists& lists) {
  std::vector<std::size_t> level(tree.nodes);
  // Children follow their parent: backwards they come first.
  for (std::size_t i = tree.nodes; i-- > 0;) {
    const shared::BvhNode& node = rest.records[tree.first_record + i];
    for (const std::uint32_t link : {node.left, node.right}) {
      if (link & shared::bvh_leaf_bit) continue;
      level[i] =
          std::max(level[i], level[(link & shared::bvh_number_mask) - tree.first_record] + 1);
    }
    if (level[i] >= lists.levels.size()) lists.levels.resize(level[i] + 1);
    lists.levels[level[i]].push_back(static_cast<std::uint32_t>(tree.first_record + i));
  }
}

gpu::FrameSize threads(std::uint32_t count) {
  return {std::clamp(count, 1u, most_threads), 1};
}

}  // namespace

DeviceRefit::Programs::Programs(const gpu::Device& device)
    : corners(device, shaders::refit_corners), boxes(device, shaders::refit_boxes) {}

DeviceRefit::DeviceRefit(const gpu::Device& device, const Programs& programs, const Bvh& rest,
                         const scene::Scene& scene, const Tables& tables)
    : plan_(device, {1, 1}) {
  Lists lists;
  for (const scene::Deformation& deformation : scene.deformations) {
    const BvhMesh& tree = rest.meshes[deformation.mesh];
    if (tree.root == shared::bvh_no_link) continue;
    const scene::Mesh& mesh = scene.meshes[deformation.mesh];
    if (!first_position_.try_emplace(deformation.mesh, lists.positions.size()).second) continue;
    add_triangles(rest, tree, mesh, lists);
    add_nodes(rest, tree, lists);
    for (const shared::Vertex& vertex : mesh.vertices) lists.positions.push_back(vertex.position);
  }
  triangle_count_ = static_cast<std::uint32_t>(lists.triangles.size());
  std::vector<std::uint32_t> nodes, first_node;
  for (const std::vector<std::uint32_t>& level : lists.levels) {
    first_node.push_back(static_cast<std::uint32_t>(nodes.size()));
    nodes.insert(nodes.end(), level.begin(), level.end());
  }
  first_node.push_back(static_cast<std::uint32_t>(nodes.size()));
  const auto positions = std::as_bytes(std::span(lists.positions));
  positions_ = gpu::Buffer(device, "refit positions", std::max<std::size_t>(positions.size(), 16),
                           storage, gpu::Memory::upload);
  std::ranges::copy(positions, positions_.mapped());
  const auto upload = [&](const char* name, const auto& list) {
    return gpu::upload_buffer(device, name, std::as_bytes(std::span(list)), storage);
  };
  triangles_ = upload("refit triangles", lists.triangles);
  nodes_ = upload("refit nodes", nodes);
  levels_ = upload("refit levels", first_node);
  const gpu::BufferRef triangles = plan_.import(tables.triangles);
  refit_corners(programs.corners, triangles);
  refit_boxes(programs.boxes, triangles, plan_.import(tables.records), first_node);
  plan_.compile();
}

void DeviceRefit::refit_corners(const gpu::ComputeProgram& program, gpu::BufferRef triangles) {
  plan_.pass("refit.corners", program)
      .read(plan_.import(positions_))
      .read(plan_.import(triangles_))
      .read_write(triangles)
      .constants(triangle_count_)
      .dispatch(threads(triangle_count_));
}

/// Wide levels by themselves, those above together in one group.
void DeviceRefit::refit_boxes(const gpu::ComputeProgram& program, gpu::BufferRef triangles,
                              gpu::BufferRef records, std::span<const std::uint32_t> first_node) {
  const auto levels = static_cast<std::uint32_t>(first_node.size() - 1);
  const auto nodes_of = [&](std::uint32_t level) {
    return first_node[level + 1] - first_node[level];
  };
  for (std::uint32_t first = 0, end; first < levels; first = end) {
    end = nodes_of(first) > shared::refit_group ? first + 1 : levels;
    plan_.pass("refit.boxes." + std::to_string(first), program)
        .read(triangles)
        .read(plan_.import(nodes_))
        .read(plan_.import(levels_))
        .read_write(records)
        .constants(shared::RefitLevels{first, end})
        .dispatch(threads(nodes_of(first)));
  }
}

void DeviceRefit::move(const Movement::Mesh& mesh) {
  const auto first = first_position_.find(mesh.mesh);
  if (first == first_position_.end()) return;
  std::byte* to = positions_.mapped() + first->second * sizeof(glm::vec3);
  for (const shared::Vertex& vertex : mesh.vertices) {
    std::memcpy(to, glm::value_ptr(vertex.position), sizeof(glm::vec3));
    to += sizeof(glm::vec3);
  }
}

void DeviceRefit::run() {
  plan_.execute();
}

}  // namespace heliograph::tracing
