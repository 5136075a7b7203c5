#include "render/passes/reference/reference_lens.hpp"

#include "render/kernels/reference/reference.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

void spread_over_lens(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays) {
  if (!in.settings.lens.depth_of_field) return;
  plan.pass("reference.lens", in.program(shaders::reference_lens))
      .bind<kernels::ReferenceLensBindings>({.count = rays.count, .rays = rays.rays})
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host(kernels::reference_lens, in.constants);
}

}  // namespace heliograph::render
