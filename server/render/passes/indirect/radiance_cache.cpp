#include "render/passes/indirect/radiance_cache.hpp"

#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

using formats::storage;

shared::RadianceCacheConstants cache_constants(const FrameInputs& in) {
  const auto& settings = in.settings.indirect;
  const float size = 2.0f * in.scene.scene->bounds.radius();
  shared::RadianceCacheConstants made{};
  made.frame_number = in.constants.sample_index;
  made.reset = in.constants.history_invalid;
  made.cell_angle = settings.cell_angle;
  made.least_size = size / 2048.0f;
  made.most_samples = static_cast<std::uint32_t>(settings.most_samples);
  made.lifetime = 32;
  made.update_probability = static_cast<float>(settings.updates) / 20000.0f;
  return made;
}

RadianceCache update_radiance_cache(gpu::FramePlan& plan, const FrameInputs& in) {
  const RadianceCache cache{
      plan.buffer("radiance_cache.keys", sizeof(std::uint32_t) * shared::cache_cells, storage,
                  gpu::Memory::device),
      plan.buffer("radiance_cache.cells", sizeof(shared::RadianceCell) * shared::cache_cells,
                  storage, gpu::Memory::device)};
  const auto rays =
      declare_rays(plan, "radiance_cache", shared::cache_cells, tracing::RayKind::reflection);
  const auto shadows = declare_rays(plan, "radiance_cache.shadows", shared::cache_cells,
                                    tracing::RayKind::hit_shadow);
  const auto hits = plan.buffer("radiance_cache.hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  const auto occluded =
      plan.buffer("radiance_cache.occluded", sizeof(std::uint32_t) * shadows.capacity, storage,
                  gpu::Memory::device);
  const auto constants = [in] { return cache_constants(in); };
  begin_rays(plan, in, "radiance_cache", rays);
  begin_rays(plan, in, "radiance_cache.shadows", shadows);
  plan.pass("radiance_cache.rays", in.program(shaders::radiance_cache_rays, in.scene.features))
      .read_write(cache.keys)
      .read_write(cache.cells)
      .read_write(rays.count)
      .write(rays.rays)
      .read_write(shadows.count)
      .write(shadows.rays)
      .constants(constants)
      .dispatch({shared::cache_cells, 1});
  in.tracer.trace_closest(plan, "radiance_cache.trace", in.structure, rays, hits);
  in.tracer.trace_any(plan, "radiance_cache.shadows.trace", in.structure, shadows, occluded);
  plan.pass("radiance_cache.shade", in.program(shaders::radiance_cache_shade, in.scene.features))
      .read(rays.count)
      .read(rays.rays)
      .read(hits)
      .read_write(cache.keys)
      .read_write(cache.cells)
      .constants(constants)
      .dispatch_indirect(rays.count, ray_groups_offset);
  plan.pass("radiance_cache.light", in.program(shaders::radiance_cache_light))
      .read(shadows.count)
      .read(shadows.rays)
      .read(occluded)
      .read_write(cache.cells)
      .dispatch_indirect(shadows.count, ray_groups_offset);
  plan.pass("radiance_cache.blend", in.program(shaders::radiance_cache_blend))
      .read(cache.keys)
      .read_write(cache.cells)
      .constants(constants)
      .dispatch({shared::cache_cells, 1});
  return cache;
}

}  // namespace heliograph::render
