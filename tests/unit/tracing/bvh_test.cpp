#include "tracing/bvh/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/traced_scene.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

struct Box {
  glm::vec3 low;
  glm::vec3 high;
};

Box left_box(const shared::BvhNode& node) {
  return {{node.left_xy.x, node.left_xy.z, node.both_z.x},
          {node.left_xy.y, node.left_xy.w, node.both_z.y}};
}

Box right_box(const shared::BvhNode& node) {
  return {{node.right_xy.x, node.right_xy.z, node.both_z.z},
          {node.right_xy.y, node.right_xy.w, node.both_z.w}};
}

bool is_leaf(std::uint32_t link) {
  return link & shared::bvh_leaf_bit;
}

std::uint32_t leaf_count(std::uint32_t link) {
  return ((link >> shared::bvh_leaf_count_shift) & shared::bvh_leaf_count_mask) + 1;
}

shared::BvhTriangle triangle_at(const Bvh& bvh, std::size_t index) {
  std::array<glm::vec4, 3> texels;
  for (std::size_t i = 0; i < 3; ++i) texels[i] = bvh.triangles[3 * index + i];
  return std::bit_cast<shared::BvhTriangle>(texels);
}

/// In the order of its leaves.
std::vector<shared::BvhTriangle> triangles_of(const Bvh& bvh, const BvhMesh& tree) {
  std::vector<shared::BvhTriangle> all;
  for (std::size_t i = 0; i < tree.triangles; ++i) {
    all.push_back(triangle_at(bvh, tree.first_triangle + i));
  }
  return all;
}

/// Visits all nodes under `link`, checks that boxes contain their subtree, and counts triangles.
void check_mesh(const Bvh& bvh, std::uint32_t link, const Box& box, float slack,
                std::map<std::uint32_t, int>& seen) {
  if (!is_leaf(link)) {
    const shared::BvhNode& node = bvh.records[link & shared::bvh_number_mask];
    for (const auto& [child, inner] :
         {std::pair(node.left, left_box(node)), std::pair(node.right, right_box(node))}) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(inner.low[axis], box.low[axis]);
        EXPECT_LE(inner.high[axis], box.high[axis]);
      }
      check_mesh(bvh, child, inner, slack, seen);
    }
    return;
  }
  const std::uint32_t first = link & shared::bvh_leaf_first_mask;
  for (std::uint32_t i = first; i < first + leaf_count(link); ++i) {
    const shared::BvhTriangle triangle = triangle_at(bvh, i);
    ++seen[triangle.triangle & shared::bvh_number_mask];
    for (const glm::vec3& corner : {triangle.corner0, triangle.corner1, triangle.corner2}) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(corner[axis], box.low[axis] - slack);
        EXPECT_LE(corner[axis], box.high[axis] + slack);
      }
    }
  }
}

/// All instance records under the top level.
std::vector<shared::BvhInstance> instances_below(const Bvh& bvh, std::uint32_t link) {
  if (link == shared::bvh_no_link) return {};
  if (is_leaf(link)) {
    return {std::bit_cast<shared::BvhInstance>(bvh.records[link & shared::bvh_leaf_first_mask])};
  }
  const shared::BvhNode& node = bvh.records[link & shared::bvh_number_mask];
  std::vector<shared::BvhInstance> result = instances_below(bvh, node.left);
  for (const auto& instance : instances_below(bvh, node.right)) result.push_back(instance);
  return result;
}

class BvhTest : public testing::Test {
 protected:
  /// All instances as such, unless `layout` says otherwise.
  Bvh build(const scene::Scene& scene, const BvhLayout& layout = {.flat = false}) const {
    return build_bvh(device_.get(), scene, layout);
  }
  EmbreeHandle<RTCDevice> device_ = make_embree_device();
};

constexpr Box everywhere{glm::vec3(-1e30f), glm::vec3(1e30f)};

TEST_F(BvhTest, ContainsEveryTriangleOnceWithinItsBoxes) {
  const scene::Scene scene = two_level_scene(1);
  const Bvh bvh = build(scene);
  const auto instances = instances_below(bvh, bvh.root);
  ASSERT_EQ(instances.size(), scene.instances.size());
  std::map<std::uint32_t, int> placed;
  for (const shared::BvhInstance& record : instances) {
    const std::uint32_t index = record.instance & shared::bvh_number_mask;
    ++placed[index];
    std::map<std::uint32_t, int> seen;
    check_mesh(bvh, record.root, everywhere, 1e-5f, seen);
    const scene::Mesh& mesh = scene.meshes.at(scene.instances.at(index).mesh);
    EXPECT_EQ(seen.size(), mesh.indices.size() / 3);
    for (const auto& [triangle, count] : seen) EXPECT_EQ(count, 1) << "triangle " << triangle;
  }
  EXPECT_EQ(placed.size(), scene.instances.size());
  EXPECT_TRUE(bvh.masked);
  EXPECT_LE(bvh.depth, shared::bvh_stack_size);
}

/// Instances beside the links of the upper level's nodes, in order of their numbers.
std::vector<std::uint32_t> instances_of_nodes(const Bvh& bvh) {
  std::vector<std::uint32_t> found;
  const auto [first, count] = bvh.upper_nodes;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const std::uint32_t link : {bvh.records.at(i).left, bvh.records.at(i).right}) {
      if (!is_leaf(link)) continue;
      const auto record =
          std::bit_cast<shared::BvhInstance>(bvh.records.at(link & shared::bvh_leaf_first_mask));
      found.push_back(record.instance & shared::bvh_number_mask);
    }
  }
  std::ranges::sort(found);
  return found;
}

// gbuffer_tiles.comp reads their boxes there.
TEST_F(BvhTest, UpperNodesHaveEveryInstanceOnce) {
  scene::Scene scene = two_level_scene(1);
  for (const bool all : {true, false}) {
    if (!all) scene.nodes.at(scene.instances.at(2).node).world = glm::mat4(0.0f);
    const Bvh bvh = build(scene);
    std::vector<std::uint32_t> expected;
    for (const shared::BvhInstance& record : instances_below(bvh, bvh.root)) {
      expected.push_back(record.instance & shared::bvh_number_mask);
    }
    std::ranges::sort(expected);
    EXPECT_EQ(expected.size(), scene.instances.size() - (all ? 0 : 1));
    EXPECT_EQ(instances_of_nodes(bvh), expected);
  }
}

float half_area(const Box& box) {
  const glm::vec3 size = box.high - box.low;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

// Shadow rays take the children in this order.
TEST_F(BvhTest, TheLargerChildComesFirst) {
  const Bvh bvh = build(two_level_scene(4));
  std::size_t nodes = 0;
  for (const BvhMesh& mesh : bvh.meshes) {
    for (std::size_t i = mesh.first_record; i < mesh.first_record + mesh.nodes; ++i) {
      const float left = half_area(left_box(bvh.records[i]));
      EXPECT_GE(left * 1.000001f, half_area(right_box(bvh.records[i])));
      ++nodes;
    }
  }
  EXPECT_GT(nodes, 100u);
}

/// Checks that leaves under `link` hold all triangles of instances that rays can hit, at their
/// places in the world.
void check_flat(const Bvh& bvh, const scene::Scene& scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, shared::BvhTriangle> seen;
  for (const shared::BvhTriangle& triangle : triangles_of(bvh, bvh.flat_tree)) {
    seen[{triangle.instance & shared::bvh_number_mask,
          triangle.triangle & shared::bvh_number_mask}] = triangle;
  }
  std::size_t expected = 0;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Mesh& mesh = scene.meshes.at(scene.instances[i].mesh);
    const glm::mat4& world = scene.nodes.at(scene.instances[i].node).world;
    expected += mesh.indices.size() / 3;
    for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const auto found = seen.find({i, t});
      ASSERT_NE(found, seen.end()) << "instance " << i << ", triangle " << t;
      const glm::vec3 corner(
          world * glm::vec4(mesh.vertices[mesh.indices[3 * std::size_t(t)]].position, 1.0f));
      EXPECT_LT(glm::distance(found->second.corner0, corner), 1e-5f * (1.0f + glm::length(corner)));
      EXPECT_EQ(found->second.mask, bvh.meshes[scene.instances[i].mesh].mask);
    }
  }
  EXPECT_EQ(seen.size(), expected);
}

TEST_F(BvhTest, StaticInstancesAreOneTreeInWorldSpace) {
  const scene::Scene scene = two_level_scene(1);
  const Bvh bvh = build(scene, {});
  const auto instances = instances_below(bvh, bvh.root);
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_EQ(instances[0].flat_tree & shared::bvh_number_mask, 1u);
  EXPECT_EQ(instances[0].root, bvh.flat_tree.root);
  check_flat(bvh, scene);
  EXPECT_TRUE(bvh.masked);
  EXPECT_LE(bvh.depth, shared::bvh_stack_size);
}

// gbuffer_small.comp draws each triangle once.
TEST_F(BvhTest, EveryTriangleIsOnceTheFirst) {
  scene::Scene scene;
  // Large diagonal quads among small spheres: their boxes are split.
  const std::uint32_t small = add_mesh(scene, sphere(6), plain_material());
  const std::uint32_t large = add_mesh(scene, quad(), plain_material());
  for (int i = 0; i < 125; ++i) {
    const glm::vec3 at(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
    place(scene, small, glm::scale(glm::translate(glm::mat4(1.0f), 4.0f * at), glm::vec3(0.5f)));
  }
  for (int i = 0; i < 20; ++i) {
    const glm::vec3 axis(i % 3, 1, i % 2 + 1);
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 0.7f + static_cast<float>(i), axis);
    place(scene, large, glm::scale(turned, glm::vec3(10)));
  }
  const Bvh bvh = build(scene, {});
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> firsts;
  for (const shared::BvhTriangle& triangle : triangles_of(bvh, bvh.flat_tree)) {
    firsts[{triangle.instance, triangle.triangle & shared::bvh_number_mask}] +=
        (triangle.triangle & shared::bvh_again_bit) == 0;
  }
  EXPECT_GT(bvh.flat_tree.triangles, firsts.size()) << "none is split";
  for (const auto& [triangle, count] : firsts) EXPECT_EQ(count, 1);
}

// gbuffer_small.comp leaves them out where the camera sees their backs.
TEST_F(BvhTest, OneSidedTrianglesAreMarkedUnlessAMirrorTurnsThem) {
  scene::Scene scene;
  shared::Material both = plain_material();
  both.flags |= shared::material_double_sided;
  const std::uint32_t one_sided = add_mesh(scene, quad(), plain_material());
  const std::uint32_t two_sided = add_mesh(scene, quad(), both);
  const glm::mat4 mirrored = glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1));
  place(scene, one_sided, glm::rotate(glm::mat4(1.0f), 2.0f, glm::vec3(1, 2, 3)));
  place(scene, two_sided, glm::mat4(1.0f));
  place(scene, one_sided, mirrored);
  place(scene, one_sided, glm::scale(mirrored, glm::vec3(2, 2, -2)));
  const Bvh bvh = build(scene, {});
  ASSERT_GE(bvh.flat_tree.triangles, 8u);
  for (const shared::BvhTriangle& triangle : triangles_of(bvh, bvh.flat_tree)) {
    const std::uint32_t instance = triangle.instance;
    const std::uint32_t number = instance & shared::bvh_number_mask;
    EXPECT_EQ((instance & shared::bvh_one_sided_bit) != 0, number == 0 || number == 3) << number;
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(instance)));
  }
}

// Half a metre of rounding turns a quad of two metres.
TEST_F(BvhTest, TrianglesThatRoundingTurnsAreNotMarked) {
  scene::Scene scene;
  scene::Mesh far = quad();
  const glm::vec3 away(4000000.1f, 3000000.3f, 5000000.7f);
  for (shared::Vertex& vertex : far.vertices) vertex.position += away;
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 1.0f, glm::vec3(1, 2, 3));
  place(scene, add_mesh(scene, far, plain_material()), glm::translate(turned, -away));
  place(scene, add_mesh(scene, quad(), plain_material()), turned);
  const Bvh bvh = build(scene, {});
  int marked = 0;
  for (const shared::BvhTriangle& triangle : triangles_of(bvh, bvh.flat_tree)) {
    if ((triangle.instance & shared::bvh_one_sided_bit) == 0) continue;
    EXPECT_EQ(triangle.instance & shared::bvh_number_mask, 1u);
    ++marked;
  }
  EXPECT_GE(marked, 2);
}

TEST_F(BvhTest, LargeCopiesStayInstances) {
  scene::Scene scene;
  const std::uint32_t copied = add_mesh(scene, sphere(8), plain_material());
  place(scene, copied, glm::mat4(1.0f));
  place(scene, copied, glm::translate(glm::mat4(1.0f), {3, 0, 0}));
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  const Bvh bvh = build(scene, {.most_bytes = 1000});
  EXPECT_EQ(bvh.flat, (std::vector<bool>{false, false, true}));
  EXPECT_EQ(instances_below(bvh, bvh.root).size(), 3u);
}

TEST_F(BvhTest, LinksAreNormalFloats) {
  const Bvh bvh = build(two_level_scene(2));
  for (const shared::BvhInstance& record : instances_below(bvh, bvh.root)) {
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(record.root)));
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(record.instance)));
    EXPECT_TRUE(record.mask == shared::bvh_no_link ||
                std::isnormal(std::bit_cast<float>(record.mask)));
  }
}

TEST_F(BvhTest, EmptySceneHasNoRoot) {
  EXPECT_EQ(build({}).root, shared::bvh_no_link);
  scene::Scene scene;
  add_mesh(scene, quad(), plain_material());
  EXPECT_EQ(build(scene).root, shared::bvh_no_link) << "no instance";
  place(scene, add_mesh(scene, {}, plain_material()), glm::mat4(1.0f));
  EXPECT_EQ(build(scene).root, shared::bvh_no_link) << "a mesh without triangles";
}

TEST_F(BvhTest, OneTriangleInOneInstance) {
  Random random(3);
  scene::Scene scene;
  place(scene, add_mesh(scene, triangle_soup(random, 1, 1.0f), plain_material()), glm::mat4(1.0f));
  const Bvh bvh = build(scene);
  ASSERT_TRUE(is_leaf(bvh.root));
  const auto instances = instances_below(bvh, bvh.root);
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_TRUE(is_leaf(instances[0].root));
  EXPECT_EQ(leaf_count(instances[0].root), 1u);
}

TEST_F(BvhTest, ExcludesDegenerateInstances) {
  scene::Scene scene;
  shared::Material invisible = plain_material();
  invisible.flags = shared::material_alpha_mask;
  invisible.base_color.w = 0.2f;
  const std::uint32_t plain = add_mesh(scene, quad(), plain_material());
  place(scene, add_mesh(scene, quad(), invisible), glm::mat4(1.0f));
  place(scene, plain, glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 0.0f, 1.0f)));
  place(scene, plain, glm::mat4(1.0f));
  const Bvh bvh = build(scene);
  const auto instances = instances_below(bvh, bvh.root);
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_EQ(instances[0].instance & shared::bvh_number_mask, 2u);
}

TEST_F(BvhTest, StaysShallowForThousandsOfEqualTriangles) {
  Random random(4);
  scene::Mesh mesh = triangle_soup(random, 1, 1.0f);
  for (int i = 0; i < 5000; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  scene::Scene scene;
  place(scene, add_mesh(scene, mesh, plain_material()), glm::mat4(1.0f));
  EXPECT_LT(build(scene).depth, 24u);
}

TEST_F(BvhTest, DepthFitsStackForGeometricSeriesOfTriangles) {
  scene::Mesh mesh;
  float size = 1e6f;
  for (int i = 0; i < 70; ++i, size *= 0.5f) {
    for (const glm::vec3& corner : {glm::vec3(0, 0, 0), {1, 0, 0.5f}, {0, 1, 0.5f}}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      add_vertex(mesh, size * (corner + 1.0f), {});
    }
  }
  scene::Scene scene;
  place(scene, add_mesh(scene, mesh, plain_material()), glm::mat4(1.0f));
  EXPECT_LE(build(scene).depth, shared::bvh_stack_size);
}

TEST_F(BvhTest, IgnoresNonFiniteTriangles) {
  Random random(5);
  scene::Mesh mesh = triangle_soup(random, 8, 1.0f);
  mesh.vertices[4].position.x = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices[7].position.y = std::numeric_limits<float>::infinity();
  scene::Scene scene;
  place(scene, add_mesh(scene, mesh, plain_material()), glm::mat4(1.0f));
  const Bvh bvh = build(scene);
  std::map<std::uint32_t, int> seen;
  check_mesh(bvh, instances_below(bvh, bvh.root).at(0).root, everywhere, 1e-5f, seen);
  EXPECT_EQ(seen.size(), 6u);
  EXPECT_FALSE(seen.contains(1) || seen.contains(2));
}

}  // namespace
}  // namespace heliograph::tracing
