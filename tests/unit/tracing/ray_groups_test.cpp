#include <gtest/gtest.h>

#include "render/kernels/common/ray_sink.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::tracing {
namespace {

TEST(RayGroups, FewRaysAreSpreadAndManyFillTheirGroups) {
  using shared::tracing_groups;
  EXPECT_EQ(tracing_groups(0), 0u);
  EXPECT_EQ(tracing_groups(1), 1u);
  EXPECT_EQ(tracing_groups(shared::least_rays_per_group + 1), 2u);
  EXPECT_EQ(tracing_groups(shared::spread_groups * 20), shared::spread_groups);
  EXPECT_EQ(tracing_groups(shared::spread_groups * shared::rays_per_group + 1),
            shared::spread_groups + 1);
}

TEST(RayGroups, TheirNumberNeverFallsAsRaysAreAdded) {
  std::uint32_t before = 0;
  for (std::uint32_t rays = 0; rays < 400'000; ++rays) {
    const std::uint32_t groups = shared::tracing_groups(rays);
    ASSERT_GE(groups, before) << rays;
    ASSERT_LE(rays, groups * shared::rays_per_group) << rays;
    before = groups;
  }
}

TEST(RayGroups, LongStreamsTakeSeveralRows) {
  const shared::RayCount count = render::kernels::full_count(3 * shared::rays_per_row + 1, 5);
  EXPECT_EQ(count.count, 3 * shared::rays_per_row + 1);
  EXPECT_EQ(count.blending, 5u);
  EXPECT_EQ(count.groups_x, shared::groups_per_row);
  EXPECT_EQ(count.groups_y, 4u);
  EXPECT_EQ(count.tracing_groups_x, shared::groups_per_row);
  EXPECT_EQ(count.tracing_groups_y, 4u);
  EXPECT_EQ(count.groups_z, 1u);
  EXPECT_EQ(count.tracing_groups_z, 1u);
}

// Kernels that count rays themselves leave the other members as they may be.
TEST(RayGroups, BothDispatchesHaveAllOfTheirDimensions) {
  shared::RayCount count{.count = shared::rays_per_group + 1};
  render::kernels::set_groups(count);
  EXPECT_EQ(count.groups_x, 2u);
  EXPECT_EQ(count.groups_y, 1u);
  EXPECT_EQ(count.groups_z, 1u);
  EXPECT_EQ(count.tracing_groups_x, shared::tracing_groups(count.count));
  EXPECT_EQ(count.tracing_groups_y, 1u);
  EXPECT_EQ(count.tracing_groups_z, 1u);
}

}  // namespace
}  // namespace heliograph::tracing
