#include "tracing/embree/embree_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "tests/support/traced_scene.hpp"
#include "tracing/embree/embree_batch.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

struct TraceResults {
  std::vector<shared::Hit> hits;
  std::vector<std::uint32_t> occluded;
};

TraceResults trace(const scene::Scene& scene, std::span<const shared::Ray> rays) {
  const auto device = make_embree_device();
  const EmbreeScene built(device.get(), scene,
                          make_embree_meshes(device.get(), scene, scene.alpha_heap));
  TraceResults results{std::vector<shared::Hit>(rays.size()),
                       std::vector<std::uint32_t>(rays.size())};
  for (std::size_t i = 0; i < rays.size(); i += embree_batch) {
    const auto batch = rays.subspan(i, std::min(embree_batch, rays.size() - i));
    intersect_batch(built.handle(), batch, 0, &results.hits[i]);
    occluded_batch(built.handle(), batch, 0, &results.occluded[i]);
  }
  return results;
}

TEST(EmbreeScene, MatchesBruteForce) {
  const scene::Scene scene = two_level_scene(11);
  // Not a multiple of any packet or batch.
  const std::vector<shared::Ray> rays = random_rays(scene, 3001, 11);
  const TraceResults results = trace(scene, rays);
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

TEST(EmbreeScene, ExcludesDegenerateInstances) {
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
  const shared::Hit hit = trace(scene, rays).hits[0];
  EXPECT_EQ(hit.instance, 3u);
  EXPECT_FLOAT_EQ(hit.t, 2.0f);
}

TEST(EmbreeScene, EmptyIntervalsHaveNoHits) {
  const scene::Scene scene = two_level_scene(12);
  std::vector<shared::Ray> rays = random_rays(scene, 300, 12);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_max = i % 2 ? rays[i].t_min : -std::numeric_limits<float>::infinity();
  }
  const TraceResults results = trace(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(results.hits[i].instance, shared::hit_none);
    EXPECT_EQ(results.occluded[i], 0u);
  }
}

}  // namespace
}  // namespace heliograph::tracing
