#include "tracing/flat_instances.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "tests/support/traced_scene.hpp"
#include "tracing/embree/embree_scene.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

constexpr std::uint64_t unlimited = ~std::uint64_t{0};

/// Two quads and three spheres, each at a node of its own.
scene::Scene five_instances() {
  scene::Scene scene;
  const std::uint32_t small = add_mesh(scene, quad(), plain_material());
  const std::uint32_t large = add_mesh(scene, sphere(8), plain_material());
  for (const std::uint32_t mesh : {small, small, large, large, large}) {
    place(scene, mesh, glm::mat4(1.0f));
  }
  return scene;
}

std::uint64_t bytes_of(const scene::Scene& scene, std::uint32_t mesh) {
  return scene.meshes[mesh].indices.size() / 3 * flat_triangle_bytes;
}

TEST(FlatInstances, AreAllThatStay) {
  scene::Scene scene = five_instances();
  EXPECT_EQ(flat_instances(scene, unlimited), std::vector<bool>(5, true));
  scene.nodes[3].parent = 1;
  scene.clips.push_back({"move", 1.0f, {{.node = 1}}});
  EXPECT_EQ(flat_instances(scene, unlimited), (std::vector<bool>{true, false, true, false, true}));
  scene.deformations.push_back({.mesh = 0});
  EXPECT_EQ(flat_instances(scene, unlimited), (std::vector<bool>{false, false, true, false, true}));
}

TEST(FlatInstances, LeaveTheLargestCopiesOut) {
  const scene::Scene scene = five_instances();
  // A single instance takes no more than the mesh's own scene would.
  const std::uint64_t copies = 2 * bytes_of(scene, 1) + bytes_of(scene, 0);
  EXPECT_EQ(flat_instances(scene, copies), std::vector<bool>(5, true));
  EXPECT_EQ(flat_instances(scene, copies - 1),
            (std::vector<bool>{true, true, false, false, false}));
  EXPECT_EQ(flat_instances(scene, bytes_of(scene, 0) - 1), std::vector<bool>(5, false));
}

TEST(FlatInstances, CountEveryCopyOfAMeshThatAlsoMoves) {
  scene::Scene scene = five_instances();
  scene.clips.push_back({"move", 1.0f, {{.node = 4}}});
  const std::uint64_t copies = 2 * bytes_of(scene, 1) + bytes_of(scene, 0);
  EXPECT_TRUE(flat_instances(scene, copies)[2]);
  EXPECT_FALSE(flat_instances(scene, copies - 1)[2]);
}

TEST(FlatInstances, SingleInstancesCostNothing) {
  scene::Scene scene;
  place(scene, add_mesh(scene, sphere(8), plain_material()), glm::mat4(1.0f));
  EXPECT_EQ(flat_instances(scene, 0), std::vector<bool>{true});
}

bool count_bytes(void* sum, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::int64_t>*>(sum) += bytes;
  return true;
}

TEST(EmbreeMemory, IsAsEstimated) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, sphere(50), plain_material());
  for (int i = 0; i < 5; ++i) {
    place(scene, mesh, glm::translate(glm::mat4(1.0f), {1.5f * static_cast<float>(i), 0, 0}));
  }
  const double triangles = 5.0 * static_cast<double>(scene.meshes[mesh].indices.size() / 3);
  std::atomic<std::int64_t> bytes = 0;
  const auto device = make_embree_device();
  rtcSetDeviceMemoryMonitorFunction(device.get(), count_bytes, &bytes);
  const auto bytes_per_triangle = [&](const EmbreeLayout& layout) {
    const std::int64_t before = bytes;
    const EmbreeScene built(device.get(), scene, scene.alpha_heap, layout);
    return static_cast<double>(bytes - before) / triangles;
  };
  const double one = bytes_per_triangle({.fast_copy = false});
  const double both = bytes_per_triangle({});
  std::printf("bytes per triangle: %.0f, with the fast copy %.0f\n", one, both);
  EXPECT_NEAR(one, flat_triangle_bytes, 0.25 * flat_triangle_bytes);
  EXPECT_LT(both - one, one) << "geometries are shared";
  EXPECT_LT(bytes_per_triangle({.flat = false}), 0.5 * one) << "instances share their mesh";
}

}  // namespace
}  // namespace heliograph::tracing
