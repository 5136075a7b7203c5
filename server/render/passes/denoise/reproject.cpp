#include "render/passes/denoise/reproject.hpp"

#include "render/kernels/reproject.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

PackedGuide declare_packed_guide(gpu::FramePlan& plan, const BufferDescription& guide,
                                 const BufferDescription& slope, gpu::FrameSize size) {
  if (plan.uses_host_kernels()) return {};
  return {plan.image(std::string(guide.name) + ".packed", formats::two_words, 0, size),
          plan.image(slope.name, formats::two_halves, 0, size)};
}

Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                const std::string& name, const ReprojectBuffers& buffers) {
  using formats::four_floats;
  const Guide guide{plan.image(buffers.guide.name, four_floats),
                    plan.image(buffers.motion.name, four_floats),
                    declare_packed_guide(plan, buffers.guide, buffers.slope)};
  plan.pass(name, in.program(shaders::reproject))
      .bind<kernels::ReprojectBindings>({.normals = gbuffer.normals,
                                         .surface = gbuffer.surface,
                                         .motion = gbuffer.motion,
                                         .depth_slope = gbuffer.depth_slope,
                                         .instance = gbuffer.instance,
                                         .previous_normals = gbuffer.previous_normals,
                                         .previous_motion = gbuffer.previous_motion,
                                         .previous_instance = gbuffer.previous_instance,
                                         .guide = guide.surface,
                                         .reprojection = guide.reprojection,
                                         .packed_guide = guide.packed.surface,
                                         .packed_slope = guide.packed.slope})
      .constants([&s = in.settings.reprojection] {
        return shared::ReprojectConstants{s.depth_tolerance, s.normal_tolerance};
      })
      .dispatch(gpu::each_pixel())
      .host(kernels::reproject, in.constants);
  return guide;
}

}  // namespace heliograph::render
