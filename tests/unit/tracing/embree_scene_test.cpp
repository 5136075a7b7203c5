#include "tracing/embree/embree_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/tracing/embree_ways.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

class EmbreeScene_ : public testing::TestWithParam<Way> {
 protected:
  static TraceResults traced(const scene::Scene& scene, std::span<const shared::Ray> rays) {
    return WayThrough(scene, GetParam()).trace(rays);
  }
};

TEST_P(EmbreeScene_, MatchesBruteForce) {
  const scene::Scene scene = two_level_scene(11);
  // Not a multiple of any packet or batch.
  const std::vector<shared::Ray> rays = random_rays(scene, 3001, 11);
  const TraceResults results = traced(scene, rays);
  int different = 0;
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const shared::Hit expected = closest_hit_brute_force(scene, rays[i]);
    const bool hit = expected.instance != shared::hit_none;
    hits += hit;
    different += !same_hit(results.hits[i], expected) || results.occluded[i] != (hit ? 1u : 0u);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LE(different, 3);
}

// Two of three instances of two_level_scene() are mirrored or turned: barycentrics must weigh the
// mesh's own vertices in all of them.
TEST_P(EmbreeScene_, BarycentricsBelongToTheMesh) {
  const scene::Scene scene = two_level_scene(13);
  const std::vector<shared::Ray> rays = random_rays(scene, 3000, 13);
  const TraceResults results = traced(scene, rays);
  int mirrored = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const shared::Hit& hit = results.hits[i];
    if (hit.instance == shared::hit_none) continue;
    const auto& [mesh_index, node] = scene.instances[hit.instance];
    const scene::Mesh& mesh = scene.meshes[mesh_index];
    const glm::mat4& world = scene.nodes[node].world;
    mirrored += glm::determinant(world) < 0.0f;
    const auto corner = [&](std::size_t c) {
      return mesh.vertices[mesh.indices[3 * std::size_t(hit.triangle) + c]].position;
    };
    const glm::vec3 point =
        (1.0f - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2);
    const glm::vec3 expected = rays[i].origin + hit.t * rays[i].direction;
    EXPECT_LT(glm::distance(glm::vec3(world * glm::vec4(point, 1.0f)), expected), 1e-4f);
  }
  EXPECT_GT(mirrored, 100);
}

TEST_P(EmbreeScene_, ExcludesDegenerateInstances) {
  scene::Scene scene;
  shared::Material invisible = plain_material();
  invisible.flags = shared::material_alpha_mask;
  invisible.base_color.w = 0.2f;
  const std::uint32_t plain = add_mesh(scene, quad(), plain_material());
  place(scene, add_mesh(scene, quad(), invisible), glm::mat4(1.0f));
  place(scene, add_mesh(scene, {}, plain_material()), glm::mat4(1.0f));
  place(scene, plain, glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 0.0f, 1.0f)));
  place(scene, plain, glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -1.0f, 0.0f)));
  const std::vector<shared::Ray> rays{{{0.2f, 1, 0.3f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0}};
  const shared::Hit hit = traced(scene, rays).hits[0];
  EXPECT_EQ(hit.instance, 3u);
  EXPECT_FLOAT_EQ(hit.t, 2.0f);
}

TEST_P(EmbreeScene_, EmptyIntervalsHaveNoHits) {
  const scene::Scene scene = two_level_scene(12);
  std::vector<shared::Ray> rays = random_rays(scene, 300, 12);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_max = i % 2 ? rays[i].t_min : -std::numeric_limits<float>::infinity();
  }
  const TraceResults results = traced(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(results.hits[i].instance, shared::hit_none);
    EXPECT_EQ(results.occluded[i], 0u);
  }
}

TEST_P(EmbreeScene_, IntervalIsOpenAtBothEnds) {
  scene::Scene scene;
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  const shared::Ray down{{0.25f, 2, 0.5f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0};
  const float reported = traced(scene, std::vector{down}).hits[0].t;
  EXPECT_FLOAT_EQ(reported, 2.0f);
  // Robust intersection compares the distance that it reports, which is rounded by the processor's
  // reciprocal. Fast intersection compares products, which are exact here.
  const float t = GetParam().robust ? reported : 2.0f;
  const float rounding = 1e-6f;
  std::vector<shared::Ray> rays(5, down);
  rays[0].t_max = t;
  rays[1].t_min = t;
  rays[2].t_min = t - rounding;
  rays[3].t_max = t + rounding;
  rays[4].origin.y = 0.0f;  // starts on the surface
  const TraceResults results = traced(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool within = i == 2 || i == 3;
    EXPECT_EQ(results.hits[i].instance == 0, within) << "ray " << i;
    EXPECT_EQ(results.occluded[i], within ? 1u : 0u) << "ray " << i;
  }
}

// What stops a ray is decided by the index of the instance, however Embree names it.
TEST_P(EmbreeScene_, BlendedSurfacesStopTheSameRays) {
  scene::Scene scene;
  shared::Material blended = masked_material(scene, shared::wrap_repeat, shared::wrap_repeat);
  blended.flags = shared::material_alpha_blend;
  const std::uint32_t mesh = add_mesh(scene, quad(), blended);
  for (int i = 0; i < 4; ++i) {
    place(scene, mesh, glm::translate(glm::mat4(1.0f), {0.0f, -0.5f * float(i), 0.0f}));
  }
  Random random(14);
  std::vector<shared::Ray> rays(2000);
  for (shared::Ray& ray : rays) {
    ray = {{uniform(random, -0.9f, 0.9f), 1, uniform(random, -0.9f, 0.9f)},
           0.0f,
           {0, -1, 0},
           10.0f,
           0,
           0,
           0,
           0};
  }
  constexpr std::uint32_t seed = 77;
  const TraceResults expected = WayThrough(scene, reference_way).trace(rays, seed);
  const TraceResults results = WayThrough(scene, GetParam()).trace(rays, seed);
  int below = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    below += expected.hits[i].instance != 0;
    EXPECT_EQ(results.hits[i].instance, expected.hits[i].instance) << "ray " << i;
    EXPECT_EQ(results.occluded[i], expected.occluded[i]) << "ray " << i;
  }
  EXPECT_GT(below, 200);
}

INSTANTIATE_TEST_SUITE_P(, EmbreeScene_, testing::ValuesIn(all_ways()), way_name);

/// A quad at the origin that a clip moves, and one below it that none does.
scene::Scene half_moving_scene() {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  place(scene, mesh, glm::mat4(1.0f));
  place(scene, mesh, glm::translate(glm::mat4(1.0f), {0.0f, -1.0f, 0.0f}));
  scene.clips.push_back({"move", 1.0f, {{.node = 0}}});
  return scene;
}

class MovingEmbreeScene : public testing::TestWithParam<RayKind> {};

TEST_P(MovingEmbreeScene, MovesOverWhatStays) {
  const scene::Scene scene = half_moving_scene();
  const auto device = make_embree_device();
  const EmbreeScene rest(device.get(), scene, scene.alpha_heap, {});
  EmbreeScene moving(device.get(), scene, rest);
  EXPECT_EQ(moving.scenes(GetParam()).flat.scene, rest.scenes(GetParam()).flat.scene)
      << "what stays is shared";
  const std::vector<shared::Ray> down{{{0.2f, 2, 0.3f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0}};
  const auto hit_of = [&](const EmbreeScene& where) {
    const Way way{.coherent = GetParam() == RayKind::camera};
    const TraceResults results = trace(where.scenes(GetParam()), down, way);
    EXPECT_EQ(results.occluded[0], 1u);
    return results.hits[0];
  };
  EXPECT_EQ(hit_of(moving).instance, 0u);
  moving.place(0, glm::translate(glm::mat4(1.0f), {0.0f, -1.5f, 0.0f}));
  moving.commit();
  EXPECT_EQ(hit_of(moving).instance, 1u) << "the one that stays is in front now";
  EXPECT_FLOAT_EQ(hit_of(moving).t, 3.0f);
  moving.place(0, glm::translate(glm::mat4(1.0f), {0.0f, 0.5f, 0.0f}));
  moving.commit();
  EXPECT_EQ(hit_of(moving).instance, 0u);
  EXPECT_FLOAT_EQ(hit_of(moving).t, 1.5f);
  EXPECT_FLOAT_EQ(hit_of(rest).t, 2.0f) << "the static scene must not change";
  EXPECT_THROW(moving.place(1, glm::mat4(1.0f)), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(, MovingEmbreeScene,
                         testing::Values(RayKind::camera, RayKind::shadow, RayKind::path));

}  // namespace
}  // namespace heliograph::tracing
