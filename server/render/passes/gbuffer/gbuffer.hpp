#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// What the rasteriser leaves for every later pass.
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
  gpu::ImageRef depth;        // reversed

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
