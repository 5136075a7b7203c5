#pragma once

#include <array>
#include <string>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/views/aspects.hpp"

namespace heliograph::render {

struct FrameInputs;

inline constexpr std::array reproject_motion_aspects{
    Aspect{"offset", ViewColors::difference, 2, offset_to_position,
           "From each pixel to where its surface was one frame ago, pixels.", "pixels"},
    Aspect{"disoccluded", ViewColors::mark, 1, one_channel<3>,
           "Surfaces that the frame before did not show: 1."}};

struct ReprojectBuffers {
  BufferDescription guide;
  BufferDescription motion;
};
inline constexpr ReprojectBuffers reproject_buffers{
    {"reproject.guide", ViewColors::direction,
     "Shading normal in world space times 1 + roughness; view Z, metres (w)."},
    {.name = "reproject.motion",
     .colors = ViewColors::heat,
     .description = "Where each surface was in the frame before: pixel (xy), bits of the valid "
                    "neighbours (z), 1 where it was disoccluded (w).",
     .aspects = reproject_motion_aspects}};
inline constexpr ReprojectBuffers indirect_reproject_buffers{
    {"indirect.reproject.guide", ViewColors::direction,
     "The same at half the size: shading normal in world space times 2; view Z, metres (w)."},
    {.name = "indirect.reproject.motion",
     .colors = ViewColors::heat,
     .description =
         "Where each surface was in the frame before, at half the size: texel (xy), bits "
         "of the valid neighbours (z), 1 where it was disoccluded (w).",
     .aspects = reproject_motion_aspects}};

/// What guides the filters of all signals.
struct Guide {
  gpu::ImageRef surface;       // shaders/lib/denoise/guide.glsl
  gpu::ImageRef reprojection;  // xy: position in the frame before, z: bits of its valid taps, w: 1
                               // where the surface was disoccluded
};

/// Finds every surface in the frame before (SVGF, section 4.1), within the tolerances of
/// `reprojection`. `name`: of the pass.
Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                const std::string& name = "reproject",
                const ReprojectBuffers& buffers = reproject_buffers);

}  // namespace heliograph::render
