#include "render/reproject.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render {

Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  const Guide guide{plan.image("denoise.guide", VK_FORMAT_R32G32B32A32_SFLOAT),
                    plan.image("denoise.reprojection", VK_FORMAT_R32G32B32A32_SFLOAT)};
  plan.pass("denoise.reproject", in.programs.compute(shaders::reproject))
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
      .constants([&s = in.settings.reprojection] {
        return shared::ReprojectConstants{s.depth_tolerance, s.normal_tolerance};
      })
      .dispatch(plan.extent())
      .describe(
          "Shading normal times 1 + roughness and view Z; and where each surface was in the "
          "frame before: pixel, valid neighbours, 1 where it was not seen.");
  return guide;
}

}  // namespace heliograph::render
