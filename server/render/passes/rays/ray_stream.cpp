#include "render/passes/rays/ray_stream.hpp"

#include <algorithm>

#include "render/kernels/common/parallel.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/ray_mask.h"

namespace heliograph::render {
namespace {

/// Rays of a strip, about: few enough for little memory, enough for every processor to have many at
/// a time.
std::uint32_t strip_rays() {
  constexpr std::uint32_t least = 1u << 17, of_processor = 1u << 14;
  return std::max(least, of_processor * static_cast<std::uint32_t>(kernels::processors()));
}

}  // namespace

std::uint32_t frame_blending(const FrameInputs& in) {
  if ((in.moving.features_without_emission() & shared::scene_blends) == 0) return 0;
  return shared::mixed_bits(in.constants.sample_index ^ shared::mixed_bits(in.constants.seed)) | 1u;
}

tracing::RayStream declare_rays(gpu::FramePlan& plan, const std::string& name,
                                std::uint32_t capacity, tracing::RayKind kind) {
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  return {plan.buffer(name + ".ray_count", sizeof(shared::RayCount),
                      storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::device),
          plan.buffer(name + ".rays", sizeof(shared::Ray) * capacity, storage, gpu::Memory::device),
          capacity, kind};
}

std::function<bool()> has_rays(const gpu::FramePlan& plan, const tracing::RayStream& rays) {
  if (!plan.uses_host_kernels()) return [] { return true; };
  return [&plan, count = rays.count] {
    return reinterpret_cast<const shared::RayCount*>(plan.get(count).mapped())->count > 0;
  };
}

std::vector<kernels::Rows> ray_strips(const gpu::FramePlan& plan, VkExtent2D extent,
                                      std::uint32_t larger) {
  const auto height = static_cast<int>(extent.height);
  constexpr auto tile = static_cast<std::uint32_t>(kernels::tile_side);
  const std::uint32_t tile_rows = std::max(larger * strip_rays() / (extent.width * tile), 1u);
  if (!plan.uses_host_kernels()) return {{0, height}};
  const int step = static_cast<int>(tile_rows * tile);
  std::vector<kernels::Rows> strips;
  for (int top = 0; top < height; top += step) {
    strips.push_back({top, std::min(top + step, height)});
  }
  return strips;
}

void begin_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                const tracing::RayStream& rays, Blending blending) {
  plan.pass(name + ".begin", in.program(shaders::rays_begin, in.moving.features_without_emission()))
      .bind<kernels::RaysBeginBindings>({.count = rays.count})
      .constants(kernels::RaysBeginConstants{blending == Blending::by_coverage})
      .dispatch({1, 1})
      .host([in](const kernels::RaysBeginJob& job) {
        kernels::rays_begin(job, job.constants.by_coverage ? frame_blending(in) : 0u);
      });
}

}  // namespace heliograph::render
