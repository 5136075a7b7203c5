#pragma once

#include <array>
#include <optional>
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
  BufferDescription slope;
};
inline constexpr ReprojectBuffers reproject_buffers{
    {"reproject.guide", ViewColors::direction,
     "Shading normal in world space times 1 + roughness; view Z, metres (w)."},
    {.name = "reproject.motion",
     .colors = ViewColors::heat,
     .description = "Where each surface was in the frame before: pixel (xy), bits of the valid "
                    "neighbours (z), 1 where it was disoccluded (w).",
     .aspects = reproject_motion_aspects},
    {"reproject.slope", ViewColors::difference,
     "Change of view Z to the pixel on the right and below, in parts of view Z."}};
inline constexpr ReprojectBuffers indirect_reproject_buffers{
    {"indirect.reproject.guide", ViewColors::direction,
     "The same at half the size: shading normal in world space times 2; view Z, metres (w)."},
    {.name = "indirect.reproject.motion",
     .colors = ViewColors::heat,
     .description =
         "Where each surface was in the frame before, at half the size: texel (xy), bits "
         "of the valid neighbours (z), 1 where it was disoccluded (w).",
     .aspects = reproject_motion_aspects},
    {"indirect.reproject.slope", ViewColors::difference,
     "Change of view Z to the next texel of half the size, in parts of view Z."}};

/// What guides a blur by halves of iterations, in half of the space
/// (shaders/lib/denoise/packed_guide.glsl). Absent where host kernels run, which read the guide and
/// the depth slope as they are.
struct PackedGuide {
  std::optional<gpu::ImageRef> surface;
  std::optional<gpu::ImageRef> slope;  // in parts of view Z
};
/// Its images, where shaders need them, for the guide and the slopes of these descriptions.
PackedGuide declare_packed_guide(gpu::FramePlan& plan, const BufferDescription& guide,
                                 const BufferDescription& slope,
                                 gpu::FrameSize size = gpu::each_pixel());

/// What guides the filters of all signals.
struct Guide {
  gpu::ImageRef surface;       // shaders/lib/denoise/guide.glsl
  gpu::ImageRef reprojection;  // xy: position in the frame before, z: bits of its valid taps, w: 1
                               // where the surface was disoccluded
  PackedGuide packed;
};

/// Finds every surface in the frame before (SVGF, section 4.1), within the tolerances of
/// `reprojection`. `name`: of the pass.
Guide reproject(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                const std::string& name = "reproject",
                const ReprojectBuffers& buffers = reproject_buffers);

}  // namespace heliograph::render
