#include "render/passes/indirect/radiance_cache.hpp"

#include <cstring>

#include "render/kernels/indirect/path_guide.hpp"
#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/lights/emissive_points.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/moving/scene_motion.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

using formats::storage;

shared::RadianceCacheConstants cache_constants(const FrameInputs& in) {
  const auto& settings = in.settings.indirect;
  const float size = 2.0f * in.scene.scene->bounds.radius();
  shared::RadianceCacheConstants made{};
  made.frame_number = in.constants.sample_index;
  // Buffers are new where the sequences begin; otherwise light has changed, and places have not.
  made.reset = in.constants.history_invalid != 0 && in.constants.sample_index == 0;
  made.forget = in.constants.history_invalid != 0 || in.scene_motion.any();
  made.cell_angle = settings.cell_angle;
  made.least_size = size / 2048.0f;
  made.cell_fraction = 0.5f;
  // A static view has time: nothing waits for its samples. A cache that knows little needs them,
  // and forgets those that were taken before light had gone around. What moves changes light here
  // and there, at every frame.
  constexpr std::uint32_t bounces = 10;
  const SceneMotion& motion = in.scene_motion;
  const bool young = in.clock.is_young() || motion.still_light_frames < FrameClock::young_frames;
  const bool moving = !motion.settled();
  const bool rests = in.clock.samples > 0 || (moving && !motion.any());
  const float factor = young || rests ? 8.0f : moving ? 4.0f : 1.0f;
  made.most_samples = static_cast<std::uint32_t>(settings.most_samples);
  if (young || moving) {
    made.most_samples = std::min(made.most_samples, shared::cache_new_samples);
  }
  made.updates = factor * static_cast<float>(settings.updates);
  made.guided = settings.path_guiding;
  made.least_weight = motion.frames_of_light(in.clock.age) < bounces ? 1.0f : young ? 0.5f : 0.0f;
  return made;
}

namespace {

struct UpdateRays {
  tracing::RayStream rays;
  tracing::RayStream shadows;
};

UpdateRays generate(gpu::FramePlan& plan, const FrameInputs& in, const RadianceCache& cache) {
  const UpdateRays made{
      // One that gathers and one between two places, for each cell.
      declare_rays(plan, "radiance_cache", 2 * shared::cache_cells, tracing::RayKind::reflection),
      declare_rays(plan, "radiance_cache.shadows", shared::cache_cells,
                   tracing::RayKind::hit_shadow)};
  begin_rays(plan, in, "radiance_cache", made.rays);
  begin_rays(plan, in, "radiance_cache.shadows", made.shadows);
  plan.pass("radiance_cache.rays", in.program(shaders::radiance_cache_rays, in.moving.features()))
      .bind<kernels::RadianceCacheRaysBindings>({.keys = cache.keys,
                                                 .cells = cache.cells,
                                                 .rays = ray_sink(made.rays),
                                                 .shadows = ray_sink(made.shadows),
                                                 .points = cache.points,
                                                 .guide = cache.guide})
      .constants([in] { return cache_constants(in); })
      .dispatch({shared::cache_cells, 1})
      .host([in](const kernels::RadianceCacheRaysJob::Pass& pass) {
        const FrameLights lights(in.tables.lights, in.constants,
                                 in.moving.features_without_emission());
        kernels::radiance_cache_rays(
            {pass, in.constants, lights.view(), in.lobe_tables(), samples_emissive(in)});
      });
  return made;
}

void shade(gpu::FramePlan& plan, const FrameInputs& in, const RadianceCache& cache,
           const tracing::RayStream& rays, gpu::BufferRef hits) {
  plan.pass("radiance_cache.shade", in.program(shaders::radiance_cache_shade, in.moving.features()))
      .bind<kernels::RadianceCacheShadeBindings>(
          {.rays = ray_source(rays), .hits = hits, .keys = cache.keys, .cells = cache.cells})
      .constants([in] { return cache_constants(in); })
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host([in](const kernels::RadianceCacheShadeJob::Pass& pass) {
        kernels::radiance_cache_shade({pass, in.constants,
                                       kernels::has_layers(in.moving.features_without_emission()),
                                       kernels::view_scene(in.scene, in.tables, in.moving),
                                       host_environment(in), in.lobe_tables()});
      });
}

void light(gpu::FramePlan& plan, const FrameInputs& in, const RadianceCache& cache,
           const tracing::RayStream& shadows) {
  const auto occluded =
      plan.buffer("radiance_cache.occluded", sizeof(std::uint32_t) * shadows.capacity, storage,
                  gpu::Memory::device);
  in.tracer.trace_any(plan, "radiance_cache.shadows.trace", in.structure, shadows, occluded);
  plan.pass("radiance_cache.light", in.program(shaders::radiance_cache_light))
      .bind<kernels::RadianceCacheLightBindings>(
          {.shadows = ray_source(shadows), .occluded = occluded, .cells = cache.cells})
      .dispatch_indirect(shadows.count, ray_groups_offset)
      .host(kernels::radiance_cache_light);
}

}  // namespace

const kernels::Environment& host_environment(const FrameInputs& in) {
  return *in.moving.environment().view(in.settings.environment.separate_sun).maps.host;
}

CacheUse radiance_cache_use(const gpu::FramePlan& plan, const RadianceCache& cache) {
  CacheUse use;
  std::memcpy(&use.cells, plan.get(cache.report).mapped(), sizeof use.cells);
  use.most_cells = shared::cache_cells;
  use.bytes =
      plan.get(cache.keys).size() + plan.get(cache.cells).size() + plan.get(cache.guide).size();
  return use;
}

RadianceCache update_radiance_cache(gpu::FramePlan& plan, const FrameInputs& in) {
  const RadianceCache cache{
      plan.buffer("radiance_cache.keys", sizeof(std::uint32_t) * shared::cache_words, storage,
                  gpu::Memory::device),
      plan.buffer("radiance_cache.cells", sizeof(shared::RadianceCell) * shared::cache_cells,
                  storage, gpu::Memory::device),
      draw_emissive_points(plan, in),
      plan.buffer("radiance_cache.guide", sizeof(shared::GuideEntry) * shared::guide_entries,
                  storage, gpu::Memory::device),
      plan.buffer("radiance_cache.report", sizeof(std::uint32_t), storage, gpu::Memory::readback)};
  plan.pass("path_guide", in.program(shaders::path_guide))
      .bind<kernels::PathGuideBindings>({.guide = cache.guide})
      .constants([in] { return cache_constants(in); })
      .dispatch({shared::guide_entries, 1})
      .when([in] { return in.settings.indirect.path_guiding; })
      .host(kernels::path_guide);
  const UpdateRays update = generate(plan, in, cache);
  const auto hits = plan.buffer("radiance_cache.hits", sizeof(shared::Hit) * update.rays.capacity,
                                storage, gpu::Memory::device);
  in.tracer.trace_closest(plan, "radiance_cache.trace", in.structure, update.rays, hits);
  shade(plan, in, cache, update.rays, hits);
  light(plan, in, cache, update.shadows);
  plan.pass("radiance_cache.blend", in.program(shaders::radiance_cache_blend))
      .bind<kernels::RadianceCacheBlendBindings>(
          {.keys = cache.keys, .cells = cache.cells, .report = cache.report, .guide = cache.guide})
      .constants([in] { return cache_constants(in); })
      .dispatch({shared::cache_cells, 1})
      .host([in](const kernels::RadianceCacheBlendJob::Pass& pass) {
        kernels::radiance_cache_blend({pass, in.constants});
      });
  return cache;
}

}  // namespace heliograph::render
