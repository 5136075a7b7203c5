#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tests/gpu/tracing/tracer_rig.hpp"

namespace heliograph::tracing {
namespace {

/// The software tracer of a device that counts as a GPU, whose lanes walk the hierarchy together.
class TraceTogether : public TracersTest {
 protected:
  void SetUp() override {
    if (!rig_->device.subgroup_ballots()) {
      GTEST_SKIP() << rig_->device.report().name << " has no subgroup ballots";
    }
    gpu::DeviceOptions options = device_options();
    options.as_gpu = true;
    device_.emplace(rig_->instance, options);
    tracer_ = make_tracer(protocol::TracerKind::software, *device_);
  }

  TracedScene traced_together(const scene::Scene& scene) const {
    return {*device_, *tracer_, scene};
  }

  std::optional<gpu::Device> device_;
  std::unique_ptr<RayTracer> tracer_;
};

/// Beside the software tracer of a processor, whose lanes walk for themselves.
class TraceTogetherAndApart : public TraceTogether {
 protected:
  void SetUp() override {
    if (!rig_->device.is_cpu()) GTEST_SKIP() << "the device is no processor";
    TraceTogether::SetUp();
  }
};

/// Of every `step` instances a clip can move one, which is not part of the flat tree; 0: none.
scene::Scene scene_with_clip(std::uint32_t seed, std::uint32_t step) {
  scene::Scene scene = two_level_scene(seed);
  if (step == 0) return scene;
  scene.clips.push_back(clip_of(scene, [step](std::uint32_t i) { return i % step == 0; }));
  return scene;
}

/// Distances of the closest hits do not depend on which lane finds them.
void expect_the_same(const TraceResults& together, const TraceResults& apart) {
  EXPECT_LT(disagreement(together, apart), 1e-3);  // triangles of equal distance
  std::size_t distances = 0, occluded = 0;
  for (std::size_t i = 0; i < apart.hits.size(); ++i) {
    const float t = apart.hits[i].t;
    distances += !(std::abs(together.hits[i].t - t) <= 1e-6f * t);
    occluded += together.occluded[i] != apart.occluded[i];
  }
  EXPECT_EQ(distances, 0u) << "of " << apart.hits.size();
  EXPECT_EQ(occluded, 0u) << "of " << apart.hits.size();
}

TEST_F(TraceTogetherAndApart, FindTheSame) {
  for (const std::uint32_t step : {0, 1, 2}) {
    const scene::Scene scene = scene_with_clip(21, step);
    const TracedScene together = traced_together(scene);
    const TracedScene apart = traced(scene, protocol::TracerKind::software);
    for (const std::size_t count : {1, 7, 600, 50'000}) {
      SCOPED_TRACE(count);
      const std::vector<shared::Ray> rays = random_rays(scene, count, 21);
      const TraceResults expected = apart.trace(rays);
      if (count > 100) {
        EXPECT_GT(hit_count(expected), count / 6);
      }
      expect_the_same(together.trace(rays), expected);
    }
  }
}

TEST_F(TraceTogetherAndApart, LetTheSameRaysThroughBlendedSurfaces) {
  scene::Scene scene = scene_with_clip(24, 2);
  for (shared::Material& material : scene.materials) {
    material.flags = shared::material_alpha_blend;
    material.base_color.w = 0.5f;
  }
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 24);
  const TracedScene together = traced_together(scene);
  const TraceResults through = together.trace(rays, 5000, 5);
  expect_the_same(through, traced(scene, protocol::TracerKind::software).trace(rays, 5000, 5));
  EXPECT_GT(disagreement(through, together.trace(rays)), 0.05) << "nothing lets rays through";
}

TEST_F(TraceTogether, MatchesBruteForce) {
  for (const std::uint32_t step : {0, 1, 2}) {
    const scene::Scene scene = scene_with_clip(23, step);
    const std::vector<shared::Ray> rays = random_rays(scene, 5000, 23);
    EXPECT_LT(disagreement(traced_together(scene).trace(rays), brute_force(scene, rays)), 1e-3)
        << step;
  }
}

}  // namespace
}  // namespace heliograph::tracing
