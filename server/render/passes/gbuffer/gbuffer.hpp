#pragma once

#include <array>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/views/aspects.hpp"

namespace heliograph::render {

struct FrameInputs;

inline constexpr std::array gbuffer_normals_aspects{
    Aspect{"geometric", ViewColors::octahedral, 2, second_pair,
           "Normals of the triangles themselves, octahedral, world space."}};
inline constexpr std::array gbuffer_base_color_aspects{
    Aspect{"occlusion", ViewColors::fraction, 1, one_channel<3>, "Occlusion texture, 0..1."}};
inline constexpr std::array gbuffer_surface_aspects{
    Aspect{"roughness", ViewColors::fraction, 1, one_channel<0>, "Perceptual roughness, 0..1."},
    Aspect{"metallic", ViewColors::fraction, 1, one_channel<1>, "Metalness, 0..1."}};
inline constexpr std::array gbuffer_motion_aspects{
    Aspect{"view_z", ViewColors::distance, 1, one_channel<3>, "Distance along the view, metres.",
           "metres"},
    Aspect{"error", ViewColors::pixels, 1, motion_error,
           "How far the motion vector is from that of a static surface, pixels.", "pixels"}};

inline constexpr struct GBufferBuffers {
  BufferDescription normals{
      .name = "gbuffer.normals",
      .colors = ViewColors::octahedral,
      .description = "Normals in world space, octahedral: shading (xy), geometric (zw).",
      .aspects = gbuffer_normals_aspects};
  BufferDescription base_color{
      .name = "gbuffer.base_color",
      .colors = ViewColors::squared,
      .description = "Square root of the linear base colour; occlusion texture (w).",
      .aspects = gbuffer_base_color_aspects};
  BufferDescription surface{.name = "gbuffer.surface",
                            .colors = ViewColors::channels,
                            .description = "Perceptual roughness, metalness, 1 where unlit.",
                            .aspects = gbuffer_surface_aspects};
  BufferDescription motion{
      .name = "gbuffer.motion",
      .colors = ViewColors::difference,
      .description =
          "Motion vectors, from each point to where it was one frame ago: fractions of "
          "the frame's width and height, view Z in metres; view Z now (w).",
      .aspects = gbuffer_motion_aspects};
  BufferDescription emissive{"gbuffer.emissive", ViewColors::radiance,
                             "Radiance that surfaces emit."};
  BufferDescription depth_slope{"gbuffer.depth_slope", ViewColors::difference,
                                "Change of view Z to the pixel on the right and below, metres.",
                                "metres"};
  BufferDescription instance{"gbuffer.instance", ViewColors::identity, "Instance + 1."};
} gbuffer_buffers{};

/// The surface that each pixel shows, for every later pass.
struct GBuffer {
  gpu::ImageRef normals;     // octahedral: shading xy, geometric zw; world space
  gpu::ImageRef base_color;  // square root of linear rgb; a: occlusion
  gpu::ImageRef surface;     // perceptual roughness of the smoother lobe, metallic, unlit
  gpu::ImageRef layers;    // what extensions add (shaders/lib/scene/layers.glsl); a placeholder of
                           // one pixel in scenes without
  gpu::ImageRef motion;    // previous uv - uv, previous view Z - view Z; w: view Z, metres, 0: none
  gpu::ImageRef emissive;  // linear radiance
  gpu::ImageRef depth_slope;  // change of view Z per pixel in x and y
  gpu::ImageRef instance;     // instance + 1, 0: none

  // The frame before, in the same encoding.
  gpu::ImageRef previous_normals;
  gpu::ImageRef previous_surface;
  gpu::ImageRef previous_motion;
  gpu::ImageRef previous_instance;
};

/// Its images, without a pass that writes them, for a scene with these features.
GBuffer declare_gbuffer(gpu::FramePlan& plan, std::uint32_t features);

/// Draws every visible instance. Motion is un-jittered; Z is linear along the view.
GBuffer rasterize_gbuffer(gpu::FramePlan& plan, const FrameInputs& in);

}  // namespace heliograph::render
