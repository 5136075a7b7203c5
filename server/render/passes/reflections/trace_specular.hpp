#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// What the specular lobe sees of the scene and the environment, one ray per pixel of a surface not
/// rougher than `specular.max_roughness`: radiance x BRDF x cos / pdf, divided by the surface's
/// specular albedo (rgb), and how far the ray went (w, metres; 10 km where it met nothing, 0 where
/// there was none).
gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer);

/// What `rays` mirror, each with its weight: stored in `radiance` at the rays' pixels. `surface`
/// holds the roughness that they come from, `distance` how far from the eye that is (a; metres).
void trace_mirrored(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                    const tracing::RayStream& rays, gpu::ImageRef surface, gpu::ImageRef distance,
                    gpu::ImageRef radiance);

/// Adds what `rays` carry to `radiance`, at the pixels of those that meet nothing.
void add_unhidden_light(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                        const tracing::RayStream& rays, gpu::ImageRef radiance);

}  // namespace heliograph::render
