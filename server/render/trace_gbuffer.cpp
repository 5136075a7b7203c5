#include "render/trace_gbuffer.hpp"

#include <string>

#include "render/frame.hpp"
#include "render/moving_scene.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render {
namespace {

constexpr int rounds = 4;
constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

tracing::RayStream make_stream(gpu::FramePlan& plan, const std::string& name,
                               std::uint32_t capacity) {
  return {plan.buffer(name + ".ray_count", sizeof(shared::RayCount),
                      storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::device),
          plan.buffer(name + ".rays", sizeof(shared::Ray) * capacity, storage,
                      gpu::Memory::device),
          capacity};
}

}  // namespace

bool traces_gbuffer(const FrameInputs& in) {
  using enum protocol::PrimaryVisibility;
  if (in.settings.gbuffer.source != automatic) return in.settings.gbuffer.source == rays;
  return in.tracer.kind() == protocol::TracerKind::embree;
}

GBuffer trace_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  GBuffer gbuffer = declare_gbuffer(plan);
  const VkExtent2D extent = plan.extent();
  // Whole tiles of 8 x 8.
  const std::uint32_t capacity = ((extent.width + 7) / 8) * ((extent.height + 7) / 8) * 64;
  const auto hits =
      plan.buffer("gbuffer.hits", sizeof(shared::Hit) * capacity, storage, gpu::Memory::device);
  const auto previous_vertices = plan.import(in.moving.previous_vertices());
  tracing::RayStream current = make_stream(plan, "gbuffer", capacity);
  tracing::RayStream next = make_stream(plan, "gbuffer.passed", capacity);

  plan.pass("gbuffer.rays", in.programs.compute(shaders::camera_rays))
      .write(current.count)
      .write(current.rays)
      .dispatch(extent);
  for (int round = 0; round < rounds; ++round) {
    const std::string name = round == 0 ? "gbuffer" : "gbuffer." + std::to_string(round + 1);
    in.tracer.trace_closest(plan, name + ".trace", in.structure, current, hits);
    plan.pass(name + ".begin", in.programs.compute(shaders::begin_rays))
        .write(next.count)
        .dispatch({1, 1});
    plan.pass(name + ".shade", in.programs.compute(shaders::gbuffer_hits, in.scene.features))
        .read(current.count)
        .read(current.rays)
        .read(hits)
        .read(previous_vertices)
        .read_write(next.count)
        .write(next.rays)
        .write(gbuffer.normals)
        .write(gbuffer.base_color)
        .write(gbuffer.surface)
        .write(gbuffer.motion)
        .write(gbuffer.emissive)
        .write(gbuffer.depth_slope)
        .write(gbuffer.instance)
        .constants(static_cast<std::uint32_t>(round == rounds - 1))
        .dispatch_indirect(current.count, offsetof(shared::RayCount, groups_x));
    std::swap(current, next);
  }
  return gbuffer;
}

}  // namespace heliograph::render
