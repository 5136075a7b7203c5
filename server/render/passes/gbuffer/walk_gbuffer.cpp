#include "render/passes/gbuffer/walk_gbuffer.hpp"

#include <cstddef>

#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/draw_camera_rays.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/gbuffer/walked_buffers.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/section/section.hpp"
#include "render/passes/shading/draw_shading.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// What the passes share.
struct Walk {
  bool layered;
  std::uint32_t features;
  WalkedBuffers<gpu::Declared> hierarchy;
  gpu::BufferRef hits;
  gpu::BufferRef previous_vertices;
  tracing::RayStream passed;  // rays that go on behind the first surface
};

/// What a surface is stored in: bindings 6 to 13 of shaders/lib/scene/gbuffer_hits.glsl.
template <class Stage>
struct StoredSurfaces {
  gpu::Write<Stage> normals;
  gpu::Write<Stage> base_color;
  gpu::Write<Stage> surface;
  gpu::Write<Stage> motion;
  gpu::Write<Stage> emissive;
  gpu::Write<Stage> depth_slope;
  gpu::Write<Stage> instance;
  gpu::OptionalWrite<Stage> layers;
};

/// Bindings 3 to 13 of shaders/lib/scene/gbuffer_round.glsl.
template <class Stage>
struct FoundSurfaces {
  gpu::ReadBuffer<Stage, shared::Vertex> previous_vertices;
  kernels::RaySink<Stage> passed;
  StoredSurfaces<Stage> surfaces;
};

/// shaders/gbuffer/gbuffer_first.comp, or gbuffer_first_layered.comp, which writes `layers`.
template <class Stage>
struct GBufferFirstBindings {
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  FoundSurfaces<Stage> found;
};

/// shaders/gbuffer/gbuffer_first_drawn.comp, or gbuffer_first_drawn_layered.comp, likewise.
template <class Stage>
struct GBufferFirstDrawnBindings {
  FoundSurfaces<Stage> found;
  WalkedBuffers<Stage> hierarchy;
  DrawnHits<Stage> hits;
};

/// shaders/gbuffer/gbuffer_trace.comp
template <class Stage>
struct GBufferTraceBindings {
  WalkedBuffers<Stage> hierarchy;
  gpu::WriteBuffer<Stage, shared::Hit> hits;
};

/// shaders/gbuffer/gbuffer_passed.comp, or gbuffer_passed_layered.comp, which writes `layers`.
template <class Stage>
struct GBufferPassedBindings {
  kernels::RaySource<Stage> passed;
  gpu::ReadBuffer<Stage, shared::Vertex> previous_vertices;
  StoredSurfaces<Stage> surfaces;
  WalkedBuffers<Stage> hierarchy;
};
struct GBufferPassedConstants {
  std::uint32_t root;
  std::uint32_t rounds;
};

StoredSurfaces<gpu::Declared> stored_surfaces(const GBuffer& gbuffer, bool layered) {
  return {.normals = gbuffer.normals,
          .base_color = gbuffer.base_color,
          .surface = gbuffer.surface,
          .motion = gbuffer.motion,
          .emissive = gbuffer.emissive,
          .depth_slope = gbuffer.depth_slope,
          .instance = gbuffer.instance,
          .layers = layered ? std::optional(gbuffer.layers) : std::nullopt};
}

Walk declare_walk(gpu::FramePlan& plan, const FrameInputs& in,
                  const tracing::WalkedHierarchy& hierarchy) {
  const VkExtent2D extent = plan.extent();
  const std::uint32_t capacity =
      camera_ray_capacity(extent.width, {0, static_cast<int>(extent.height)});
  const std::uint32_t features = in.moving.features_without_emission();
  return {.layered = (features & shared::scene_layers) != 0,
          .features = features,
          .hierarchy = walked_buffers(plan, hierarchy),
          .hits = plan.buffer("gbuffer.hits", sizeof(shared::Hit) * capacity, formats::storage,
                              gpu::Memory::device),
          .previous_vertices = plan.import(in.moving.previous_vertices()),
          .passed = declare_rays(plan, "gbuffer.passed", capacity, tracing::RayKind::camera)};
}

FoundSurfaces<gpu::Declared> found_surfaces(const Walk& walk, const GBuffer& gbuffer) {
  return {.previous_vertices = walk.previous_vertices,
          .passed = ray_sink(walk.passed),
          .surfaces = stored_surfaces(gbuffer, walk.layered)};
}

void store_traced(gpu::FramePlan& plan, const FrameInputs& in, const Walk& walk,
                  const GBuffer& gbuffer) {
  const auto& shader = walk.layered ? shaders::gbuffer_first_layered : shaders::gbuffer_first;
  plan.pass("gbuffer.hits", in.program(shader, walk.features))
      .bind<GBufferFirstBindings>({.hits = walk.hits, .found = found_surfaces(walk, gbuffer)})
      .dispatch(gpu::each_pixel());
}

void store_drawn(gpu::FramePlan& plan, const FrameInputs& in, const Walk& walk,
                 const GBuffer& gbuffer, const DrawnHits<gpu::Declared>& hits) {
  const auto& shader =
      walk.layered ? shaders::gbuffer_first_drawn_layered : shaders::gbuffer_first_drawn;
  plan.pass("gbuffer.hits", in.program(shader, walk.features))
      .bind<GBufferFirstDrawnBindings>(
          {.found = found_surfaces(walk, gbuffer), .hierarchy = walk.hierarchy, .hits = hits})
      .dispatch(gpu::each_pixel());
}

void find_passed(gpu::FramePlan& plan, const FrameInputs& in, const Walk& walk,
                 const tracing::WalkedHierarchy& hierarchy, const GBuffer& gbuffer) {
  const auto& shader = walk.layered ? shaders::gbuffer_passed_layered : shaders::gbuffer_passed;
  const std::uint32_t rounds = camera_rounds(in) - 1;
  plan.pass("gbuffer.passed", in.program(shader, walk.features))
      .bind<GBufferPassedBindings>({.passed = ray_source(walk.passed),
                                    .previous_vertices = walk.previous_vertices,
                                    .surfaces = stored_surfaces(gbuffer, walk.layered),
                                    .hierarchy = walk.hierarchy})
      .constants([root = hierarchy.root, rounds] {
        return GBufferPassedConstants{root(), rounds};
      })
      .dispatch_indirect(walk.passed.count, offsetof(shared::RayCount, tracing_groups_x));
}

}  // namespace

GBuffer walk_gbuffer(gpu::FramePlan& plan, const FrameInputs& in,
                     const tracing::WalkedHierarchy& hierarchy) {
  const GBuffer gbuffer = declare_gbuffer(plan, in.moving.features_without_emission());
  const Walk walk = declare_walk(plan, in, hierarchy);
  // Camera rays decide for themselves, by the filtered texel: as drawn triangles do.
  begin_rays(plan, in, "gbuffer", walk.passed, Blending::stops);
  if (draws_camera_rays(plan, in, hierarchy)) {
    const DrawnHits<gpu::Declared> hits = draw_camera_rays(
        plan, in, hierarchy, walk.hierarchy, walk.hits, most_drawn_parts(plan.extent()));
    store_drawn(plan, in, walk, gbuffer, hits);
  } else {
    plan.pass("gbuffer.trace", in.program(shaders::gbuffer_trace))
        .bind<GBufferTraceBindings>({.hierarchy = walk.hierarchy, .hits = walk.hits})
        .constants(hierarchy.root)
        .dispatch(gpu::each_pixel());
    store_traced(plan, in, walk, gbuffer);
  }
  find_passed(plan, in, walk, hierarchy, gbuffer);
  return gbuffer;
}

std::optional<tracing::WalkedHierarchy> walked_gbuffer(const gpu::FramePlan& plan,
                                                       const FrameInputs& in) {
  if (plan.device().is_cpu() || has_section(in) || changes_shading(in)) return std::nullopt;
  return in.tracer.walked(in.structure);
}

}  // namespace heliograph::render
