#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "tests/gpu/tracing/tracer_rig.hpp"

namespace heliograph::tracing {
namespace {

/// The software tracer of a device that counts as a GPU, whose lanes walk the hierarchy together,
/// and of one that counts as what it is.
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

/// Distances of the closest hits do not depend on who walks where.
void expect_the_same(const TraceResults& together, const TraceResults& apart) {
  EXPECT_LT(disagreement(together, apart), 1e-3);  // triangles of equal distance
  std::size_t distances = 0, occluded = 0;
  for (std::size_t i = 0; i < apart.hits.size(); ++i) {
    distances += together.hits[i].t != apart.hits[i].t;
    occluded += together.occluded[i] != apart.occluded[i];
  }
  EXPECT_EQ(distances, 0u) << "of " << apart.hits.size();
  EXPECT_EQ(occluded, 0u) << "of " << apart.hits.size();
}

TEST_F(TraceTogether, FindsWhatASingleLaneFinds) {
  for (const std::uint32_t seed : {21u, 22u}) {
    const scene::Scene scene = two_level_scene(seed);
    const TracedScene together = traced_together(scene);
    const TracedScene apart = traced(scene, protocol::TracerKind::software);
    for (const std::size_t count : {1, 7, 600, 100'000}) {
      SCOPED_TRACE(count);
      const std::vector<shared::Ray> rays = random_rays(scene, count, seed);
      const TraceResults expected = apart.trace(rays);
      if (count > 100) {
        EXPECT_GT(hit_count(expected), count / 6);
      }
      expect_the_same(together.trace(rays), expected);
    }
  }
}

TEST_F(TraceTogether, MatchesBruteForceWithFewAndManyRays) {
  const scene::Scene scene = two_level_scene(23);
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 23);
  EXPECT_LT(disagreement(traced_together(scene).trace(rays), brute_force(scene, rays)), 1e-3);
}

TEST_F(TraceTogether, GivesTheNumberOfTheFrameAwayWithTheRay) {
  const scene::Scene scene = two_level_scene(24);
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 24);
  constexpr std::uint32_t blending = 5;
  expect_the_same(traced_together(scene).trace(rays, 5000, blending),
                  traced(scene, protocol::TracerKind::software).trace(rays, 5000, blending));
}

}  // namespace
}  // namespace heliograph::tracing
