#include "render/trace_gbuffer.hpp"

#include <string>

#include "render/moving_scene.hpp"
#include "render/ray_stream.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

constexpr int rounds = 4;
constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

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
  tracing::RayStream current = declare_rays(plan, "gbuffer", capacity);
  tracing::RayStream next = declare_rays(plan, "gbuffer.passed", capacity);

  plan.pass("gbuffer.rays", in.programs.compute(shaders::camera_rays))
      .write(current.count)
      .write(current.rays)
      .dispatch(extent);
  for (int round = 0; round < rounds; ++round) {
    const std::string name = round == 0 ? "gbuffer" : "gbuffer." + std::to_string(round + 1);
    in.tracer.trace_closest(plan, name + ".trace", in.structure, current, hits);
    begin_rays(plan, in, name, next);
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
        .dispatch_indirect(current.count, ray_groups_offset);
    std::swap(current, next);
  }
  return gbuffer;
}

}  // namespace heliograph::render
