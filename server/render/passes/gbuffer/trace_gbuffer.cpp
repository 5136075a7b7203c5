#include "render/passes/gbuffer/trace_gbuffer.hpp"

#include <string>

#include "render/kernels/gbuffer_hits.hpp"
#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::storage;

void camera_rays(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays) {
  const auto run_host = [&plan, &frame = in.constants, rays] {
    kernels::camera_rays(frame, mapped<shared::RayCount>(plan, rays.count),
                         mapped<shared::Ray>(plan, rays.rays));
  };
  const auto bind = [&](gpu::PassBuilder pass) { return pass.write(rays.count).write(rays.rays); };
  if (by_host(plan, in)) {
    bind(plan.host("gbuffer.rays", run_host));
  } else {
    bind(plan.pass("gbuffer.rays", in.programs.compute(shaders::gbuffer_rays)))
        .dispatch(plan.extent());
  }
}

/// What one round has met.
struct Round {
  std::string name;
  bool last;
  tracing::RayStream rays;
  gpu::BufferRef hits;
  gpu::BufferRef previous_vertices;
  tracing::RayStream passed;  // rays that go on
  GBuffer gbuffer;
};

void shade_on_host(const gpu::FramePlan& plan, const FrameInputs& in, const Round& round) {
  const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
  const GBuffer& gbuffer = round.gbuffer;
  kernels::shade_gbuffer({in.constants,
                          kernels::view_scene(in.scene, in.tables, in.moving),
                          (in.scene.features & shared::scene_deforms) != 0,
                          round.last,
                          ray_source(plan, round.rays),
                          mapped<const shared::Hit>(plan, round.hits),
                          ray_sink(plan, in, round.passed, Blending::stops),
                          {view(gbuffer.normals), view(gbuffer.base_color), view(gbuffer.surface),
                           view(gbuffer.motion), view(gbuffer.emissive), view(gbuffer.depth_slope),
                           view(gbuffer.instance)}});
}

void shade(gpu::FramePlan& plan, const FrameInputs& in, const Round& round) {
  const auto bind = [&](gpu::PassBuilder pass) {
    return pass.read(round.rays.count)
        .read(round.rays.rays)
        .read(round.hits)
        .read(round.previous_vertices)
        .read_write(round.passed.count)
        .write(round.passed.rays)
        .write(round.gbuffer.normals)
        .write(round.gbuffer.base_color)
        .write(round.gbuffer.surface)
        .write(round.gbuffer.motion)
        .write(round.gbuffer.emissive)
        .write(round.gbuffer.depth_slope)
        .write(round.gbuffer.instance);
  };
  const bool layered = (in.scene.features & shared::scene_layers) != 0;
  const std::string name = round.name + ".shade";
  if (shades_on_host(plan, in)) {
    bind(plan.host(name, [&plan, in, round] { shade_on_host(plan, in, round); }));
    return;
  }
  // Camera rays decide for themselves, by the filtered texel: as drawn triangles do.
  begin_rays(plan, in, round.name, round.passed, Blending::stops);
  const auto& shader = layered ? shaders::gbuffer_hits_layered : shaders::gbuffer_hits;
  gpu::PassBuilder pass = plan.pass(name, in.programs.compute(shader, in.scene.features));
  bind(pass);
  if (layered) pass.write(round.gbuffer.layers);
  pass.constants(static_cast<std::uint32_t>(round.last))
      .dispatch_indirect(round.rays.count, ray_groups_offset);
}

}  // namespace

bool rays_find_gbuffer_sooner(const gpu::DeviceReport& device, protocol::TracerKind tracer) {
  if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) return tracer == protocol::TracerKind::embree;
  return tracer == protocol::TracerKind::software && device.rays.pipeline && !device.rays.query;
}

bool traces_gbuffer(const gpu::Device& device, const FrameInputs& in) {
  using enum protocol::PrimaryVisibility;
  if (in.settings.gbuffer.source != automatic) return in.settings.gbuffer.source == rays;
  return rays_find_gbuffer_sooner(device.report(), in.tracer.kind());
}

GBuffer trace_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  GBuffer gbuffer = declare_gbuffer(plan, in.scene.features);
  const VkExtent2D extent = plan.extent();
  // Whole tiles of 8 x 8.
  const std::uint32_t capacity = ((extent.width + 7) / 8) * ((extent.height + 7) / 8) * 64;
  const auto hits =
      plan.buffer("gbuffer.hits", sizeof(shared::Hit) * capacity, storage, gpu::Memory::device);
  const auto previous_vertices = plan.import(in.moving.previous_vertices());
  tracing::RayStream current = declare_rays(plan, "gbuffer", capacity);
  tracing::RayStream next = declare_rays(plan, "gbuffer.passed", capacity);

  camera_rays(plan, in, current);
  const int rounds = (in.scene.features & shared::scene_blends) != 0 ? 2 + most_blended : 4;
  for (int round = 0; round < rounds; ++round) {
    const std::string name = round == 0 ? "gbuffer" : "gbuffer." + std::to_string(round + 1);
    in.tracer.trace_closest(plan, name + ".trace", in.structure, current, hits);
    const bool last = round == rounds - 1;
    shade(plan, in, {name, last, current, hits, previous_vertices, next, gbuffer});
    std::swap(current, next);
  }
  return gbuffer;
}

}  // namespace heliograph::render
