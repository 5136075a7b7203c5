#include <gtest/gtest.h>

#include "render/passes/gbuffer/trace_gbuffer.hpp"

namespace heliograph::render {
namespace {

using protocol::TracerKind;

gpu::DeviceReport device(VkPhysicalDeviceType type, bool query, bool pipeline) {
  gpu::DeviceReport report;
  report.type = type;
  report.rays = {query, pipeline};
  return report;
}

TEST(GBufferSource, PrefersFasterMethodOfDevice) {
  const auto processor = device(VK_PHYSICAL_DEVICE_TYPE_CPU, true, true);
  EXPECT_TRUE(rays_find_gbuffer_sooner(processor, TracerKind::embree));
  EXPECT_FALSE(rays_find_gbuffer_sooner(processor, TracerKind::software));
  EXPECT_FALSE(rays_find_gbuffer_sooner(processor, TracerKind::ray_query));

  const auto data_center = device(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, false, true);
  EXPECT_TRUE(rays_find_gbuffer_sooner(data_center, TracerKind::software));
  EXPECT_FALSE(rays_find_gbuffer_sooner(data_center, TracerKind::ray_pipeline));

  const auto card = device(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, true, true);
  EXPECT_FALSE(rays_find_gbuffer_sooner(card, TracerKind::ray_query));
  EXPECT_FALSE(rays_find_gbuffer_sooner(card, TracerKind::software));
  const auto old_card = device(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, false, false);
  EXPECT_FALSE(rays_find_gbuffer_sooner(old_card, TracerKind::software));
}

}  // namespace
}  // namespace heliograph::render
