#include "tracing/bvh/device_refit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <vector>

#include "shaders/shared/refit.h"
#include "tests/gpu/tracing/tracer_rig.hpp"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {
namespace {

constexpr std::uint32_t a_sphere = 1;
constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

scene::Bounds left_of(const shared::BvhNode& node) {
  return {{node.left_xy.x, node.left_xy.z, node.both_z.x},
          {node.left_xy.y, node.left_xy.w, node.both_z.y}};
}

scene::Bounds right_of(const shared::BvhNode& node) {
  return {{node.right_xy.x, node.right_xy.z, node.both_z.z},
          {node.right_xy.y, node.right_xy.w, node.both_z.w}};
}

void expect_same(const scene::Bounds& found, const scene::Bounds& expected) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(found.minimum[axis], expected.minimum[axis]);
    EXPECT_EQ(found.maximum[axis], expected.maximum[axis]);
  }
}

/// The tables of a hierarchy on the device, and what comes back of them.
struct RefittedScene {
  RefittedScene(const gpu::Device& device, const scene::Scene& scene)
      : scene(scene),
        embree(make_embree_device()),
        rest(build_bvh(embree.get(), scene)),
        programs(device),
        records(
            gpu::upload_buffer(device, "records", std::as_bytes(std::span(rest.records)), storage)),
        triangles(gpu::upload_buffer(device, "triangles", std::as_bytes(std::span(rest.triangles)),
                                     storage)),
        refit(device, programs, rest, scene, {records, triangles}),
        device(device) {}

  /// Reads the tables back.
  void run() {
    refit.run();
    const auto read = [&](const gpu::Buffer& buffer, auto& to) {
      const auto bytes = gpu::download_buffer(device, buffer, std::span(to).size_bytes());
      std::memcpy(to.data(), bytes.data(), bytes.size());
    };
    read(records, rest.records);
    read(triangles, rest.triangles);
  }

  /// Checks the subtree of a link and returns its box: that of the vertices.
  scene::Bounds check(std::uint32_t link, const scene::Mesh& mesh) const {
    if (link & shared::bvh_leaf_bit) return check_leaf(link, mesh);
    const shared::BvhNode& node = rest.records[link & shared::bvh_number_mask];
    const scene::Bounds left = check(node.left, mesh), right = check(node.right, mesh);
    expect_same(left_of(node), left);
    expect_same(right_of(node), right);
    scene::Bounds both = left;
    both.include(right);
    return both;
  }

  scene::Bounds check_leaf(std::uint32_t link, const scene::Mesh& mesh) const {
    scene::Bounds box;
    const std::uint32_t first = link & shared::bvh_leaf_first_mask;
    const std::uint32_t count =
        ((link >> shared::bvh_leaf_count_shift) & shared::bvh_leaf_count_mask) + 1;
    for (std::uint32_t slot = first; slot < first + count; ++slot) {
      shared::BvhTriangle triangle;
      std::memcpy(&triangle, &rest.triangles[std::size_t(slot) * shared::bvh_texels_per_triangle],
                  sizeof(triangle));
      const std::array corners{triangle.corner0, triangle.corner1, triangle.corner2};
      const std::size_t number = triangle.triangle & shared::bvh_number_mask;
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3& vertex = mesh.vertices[mesh.indices[3 * number + i]].position;
        EXPECT_EQ(corners[i], vertex);
        box.include(vertex);
      }
    }
    return box;
  }

  const scene::Scene& scene;
  EmbreeHandle<RTCDevice> embree;
  Bvh rest;
  DeviceRefit::Programs programs;
  gpu::Buffer records;
  gpu::Buffer triangles;
  DeviceRefit refit;
  const gpu::Device& device;
};

class DeviceRefitTest : public TracersTest {};

/// A scene of placed meshes, of which `deforming` deform.
scene::Scene deforming_scene(std::initializer_list<std::uint32_t> deforming) {
  scene::Scene scene = two_level_scene(10);
  // Levels of more nodes than a group refits, and of fewer.
  scene.meshes[a_sphere] = sphere(48);
  scene.clips.emplace_back();
  for (const std::uint32_t mesh : deforming) {
    scene.deformations.push_back({.mesh = mesh, .shape = 0, .node = 0, .skin = {}});
  }
  for (const scene::Instance& instance : scene.instances) {
    scene.clips[0].channels.push_back({.node = instance.node});
  }
  return scene;
}

TEST_F(DeviceRefitTest, BoxesAreThoseOfTheVertices) {
  constexpr std::uint32_t a_masked_quad = 4, rigid = 2;
  scene::Scene scene = deforming_scene({a_sphere, a_masked_quad});
  RefittedScene refitted(rig_->device, scene);
  const std::vector<shared::BvhNode> records_at_rest = refitted.rest.records;
  EXPECT_GT(refitted.rest.meshes[a_sphere].nodes, 8u * shared::refit_group);
  Random random(3);
  for (int step = 0; step < 5; ++step) {
    for (const scene::Deformation& deformation : scene.deformations) {
      scene::Mesh& mesh = scene.meshes[deformation.mesh];
      for (shared::Vertex& vertex : mesh.vertices) vertex.position += uniform_vector(random, 0.3f);
      refitted.refit.move({deformation.mesh, mesh.vertices, {}});
    }
    refitted.run();
    for (const scene::Deformation& deformation : scene.deformations) {
      refitted.check(refitted.rest.meshes[deformation.mesh].root, scene.meshes[deformation.mesh]);
    }
    const BvhMesh& still = refitted.rest.meshes[rigid];
    for (std::size_t i = still.first_record; i < still.first_record + still.nodes; ++i) {
      EXPECT_EQ(
          std::memcmp(&refitted.rest.records[i], &records_at_rest[i], sizeof(shared::BvhNode)), 0);
    }
  }
}

// Drivers may take them for the least or the greatest of two.
TEST_F(DeviceRefitTest, VerticesThatAreNoNumbersCountForNothing) {
  scene::Scene scene = deforming_scene({a_sphere});
  RefittedScene refitted(rig_->device, scene);
  scene::Mesh& mesh = scene.meshes[a_sphere];
  scene::Bounds expected;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (i % 7 == 0) {
      mesh.vertices[i].position = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    } else {
      mesh.vertices[i].position *= 2.0f;
    }
  }
  std::vector<bool> used(mesh.vertices.size());
  for (const std::uint32_t index : mesh.indices) used[index] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] && i % 7 != 0) expected.include(mesh.vertices[i].position);
  }
  refitted.refit.move({a_sphere, mesh.vertices, {}});
  refitted.run();
  const std::uint32_t root = refitted.rest.meshes[a_sphere].root & shared::bvh_number_mask;
  scene::Bounds found = left_of(refitted.rest.records[root]);
  found.include(right_of(refitted.rest.records[root]));
  expect_same(found, expected);
}

}  // namespace
}  // namespace heliograph::tracing
