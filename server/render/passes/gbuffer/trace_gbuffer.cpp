#include "render/passes/gbuffer/trace_gbuffer.hpp"

#include <string>

#include "render/kernels/gbuffer/gbuffer_hits.hpp"
#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/walk_gbuffer.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/section/section.hpp"
#include "render/passes/shading/draw_shading.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::storage;

/// The hits of one round.
struct Round {
  std::string name;
  bool last;
  tracing::RayStream rays;
  gpu::BufferRef hits;
  gpu::BufferRef previous_vertices;
  tracing::RayStream passed;  // rays that go on
};

void store_hits(gpu::FramePlan& plan, const FrameInputs& in, const Round& round,
                const GBuffer& gbuffer) {
  const std::uint32_t features = in.moving.features_without_emission();
  const bool layered = (features & shared::scene_layers) != 0;
  const auto& shader = layered ? shaders::gbuffer_hits_layered : shaders::gbuffer_hits;
  plan.pass(round.name + ".hits", in.program(shader, features))
      .bind<kernels::GBufferHitsBindings>(
          {.rays = ray_source(round.rays),
           .hits = round.hits,
           .previous_vertices = round.previous_vertices,
           .passed = ray_sink(round.passed),
           .normals = gbuffer.normals,
           .base_color = gbuffer.base_color,
           .surface = gbuffer.surface,
           .motion = gbuffer.motion,
           .emissive = gbuffer.emissive,
           .depth_slope = gbuffer.depth_slope,
           .instance = gbuffer.instance,
           .layers = layered ? std::optional(gbuffer.layers) : std::nullopt})
      .constants(kernels::GBufferHitsConstants{round.last})
      .dispatch_indirect(round.rays.count, ray_groups_offset)
      .host([in](const kernels::GBufferHitsJob::Pass& pass) {
        kernels::gbuffer_hits(
            {pass, in.constants, kernels::view_scene(in.scene, in.tables, in.moving),
             (in.moving.features_without_emission() & shared::scene_deforms) != 0});
      });
}

}  // namespace

bool rays_find_gbuffer_sooner(const gpu::DeviceReport& device, protocol::TracerKind tracer) {
  if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) return tracer == protocol::TracerKind::embree;
  return tracer == protocol::TracerKind::software && device.rays.pipeline && !device.rays.query;
}

bool traces_gbuffer(const gpu::Device& device, const FrameInputs& in) {
  using enum protocol::PrimaryVisibility;
  if (has_section(in) || changes_shading(in)) return true;
  if (in.settings.gbuffer.source != automatic) return in.settings.gbuffer.source == rays;
  return rays_find_gbuffer_sooner(device.report(), in.tracer.kind());
}

std::uint32_t camera_ray_capacity(std::uint32_t width, kernels::Rows rows) {
  const auto height = static_cast<std::uint32_t>(rows.bottom - rows.top);
  return ((width + 7) / 8) * ((height + 7) / 8) * 64;
}

void camera_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                 const tracing::RayStream& rays, kernels::Rows rows) {
  plan.pass(name, in.program(shaders::gbuffer_rays))
      .bind<kernels::GBufferRaysBindings>({.count = rays.count, .rays = rays.rays})
      .dispatch(gpu::each_pixel())
      .host([&frame = in.constants, rows](const kernels::GBufferRaysJob::Pass& pass) {
        kernels::gbuffer_rays({pass, frame, rows});
      });
}

std::uint32_t camera_rounds(const FrameInputs& in) {
  return (in.moving.features_without_emission() & shared::scene_blends) != 0 ? 2 + most_blended : 4;
}

GBuffer trace_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  if (const auto hierarchy = walked_gbuffer(plan, in)) return walk_gbuffer(plan, in, *hierarchy);
  GBuffer gbuffer = declare_gbuffer(plan, in.moving.features_without_emission());
  const VkExtent2D extent = plan.extent();
  const kernels::Rows rows{0, static_cast<int>(extent.height)};
  const std::uint32_t capacity = camera_ray_capacity(extent.width, rows);
  auto current = declare_rays(plan, "gbuffer", capacity, tracing::RayKind::camera);
  auto next = declare_rays(plan, "gbuffer.passed", capacity, tracing::RayKind::camera);
  const gpu::BufferRef hits =
      plan.buffer("gbuffer.hits", sizeof(shared::Hit) * capacity, storage, gpu::Memory::device);
  const auto previous_vertices = plan.import(in.moving.previous_vertices());
  camera_rays(plan, in, "gbuffer.rays", current, rows);
  const SectionCaps caps = declare_caps(plan, in, "section.caps");
  const std::uint32_t last_round = camera_rounds(in);
  for (std::uint32_t round = 1; round <= last_round; ++round) {
    const std::string name = round == 1 ? "gbuffer" : "gbuffer." + std::to_string(round);
    // Camera rays decide for themselves, by the filtered texel: as drawn triangles do.
    begin_rays(plan, in, name, next, Blending::stops);
    const bool finds_caps = caps && round == 1;
    const auto trace = [&] {
      in.tracer.trace_closest(plan, name + ".trace", in.structure, current, hits);
      if (finds_caps) find_caps(plan, in, current, hits, caps);
      const bool last = round == last_round;
      store_hits(plan, in, {name, last, current, hits, previous_vertices, next}, gbuffer);
      draw_shading(plan, in, current, hits, gbuffer);
    };
    // The first rays are there in every frame, and so is what they find: images that every frame
    // writes can be read after it.
    if (round == 1) {
      trace();
    } else {
      plan.only_when(has_rays(plan, current), trace);
    }
    std::swap(current, next);
  }
  draw_caps(plan, in, caps, gbuffer);
  return gbuffer;
}

}  // namespace heliograph::render
