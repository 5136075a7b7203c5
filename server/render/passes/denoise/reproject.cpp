#include "render/passes/denoise/reproject.hpp"

#include "render/kernels/reproject.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// The shader, or its twin where the device's memory is the host's.
gpu::PassBuilder declare_pass(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                              const Guide& guide) {
  const auto constants = [&s = in.settings.reprojection] {
    return shared::ReprojectConstants{s.depth_tolerance, s.normal_tolerance};
  };
  if (!on_host(plan, in)) {
    return plan.pass("denoise.reproject", in.programs.compute(shaders::reproject))
        .constants(constants)
        .dispatch(plan.extent());
  }
  return plan.host("denoise.reproject", [&plan, &frame = in.constants, gbuffer, guide, constants] {
    const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
    kernels::reproject({.frame = frame,
                        .constants = constants(),
                        .width = static_cast<int>(plan.extent().width),
                        .height = static_cast<int>(plan.extent().height),
                        .normals = view(gbuffer.normals),
                        .surface = view(gbuffer.surface),
                        .motion = view(gbuffer.motion),
                        .depth_slope = view(gbuffer.depth_slope),
                        .instance = view(gbuffer.instance),
                        .previous_normals = view(gbuffer.previous_normals),
                        .previous_motion = view(gbuffer.previous_motion),
                        .previous_instance = view(gbuffer.previous_instance),
                        .guide = view(guide.surface),
                        .reprojection = view(guide.reprojection)});
  });
}

}  // namespace

Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  const Guide guide{plan.image("denoise.guide", VK_FORMAT_R32G32B32A32_SFLOAT),
                    plan.image("denoise.reprojection", VK_FORMAT_R32G32B32A32_SFLOAT)};
  declare_pass(plan, in, gbuffer, guide)
      .read(gbuffer.normals)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read(gbuffer.depth_slope)
      .read(gbuffer.instance)
      .read(gbuffer.previous_normals)
      .read(gbuffer.previous_motion)
      .read(gbuffer.previous_instance)
      .write(guide.surface)
      .write(guide.reprojection)
      .describe(
          "Shading normal times 1 + roughness and view Z; and where each surface was in the "
          "frame before: pixel, valid neighbours, 1 where it was not seen.");
  return guide;
}

}  // namespace heliograph::render
