#include "render/passes/indirect/trace_indirect.hpp"

#include "render/passes/formats.hpp"
#include "render/passes/indirect/radiance_cache.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

using formats::storage;

gpu::ImageRef trace_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const RadianceCache& cache, std::optional<gpu::ImageRef> planned) {
  const auto radiance = plan.image(indirect_buffers.radiance.name, formats::four_floats);
  const VkExtent2D extent = plan.extent();
  const auto rays =
      declare_rays(plan, "indirect", extent.width * extent.height, tracing::RayKind::reflection);
  begin_rays(plan, in, "indirect", rays);
  plan.pass("indirect.rays", in.program(shaders::indirect_rays))
      .read(gbuffer.normals)
      .read(gbuffer.motion)
      .read_write(rays.count)
      .write(rays.rays)
      .read(planned.value_or(gbuffer.instance))
      .write(radiance)
      .constants([in, has_plan = planned.has_value()] {
        return static_cast<std::uint32_t>(has_plan && leaves_samples_out(in));
      })
      .dispatch(gpu::each_pixel());
  const auto hits = plan.buffer("indirect.hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, "indirect.trace", in.structure, rays, hits);
  plan.pass("indirect.shade", in.program(shaders::indirect_shade, in.scene.features))
      .read(rays.count)
      .read(rays.rays)
      .read(hits)
      .read_write(cache.keys)
      .read_write(cache.cells)
      .write(radiance)
      .constants([in] { return cache_constants(in); })
      .dispatch_indirect(rays.count, ray_groups_offset);
  return radiance;
}

}  // namespace heliograph::render
