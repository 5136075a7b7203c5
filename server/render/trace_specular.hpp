#pragma once

#include "render/gbuffer.hpp"

namespace heliograph::render {

/// What the specular lobe sees of the scene and the environment, one ray per pixel of a surface not
/// rougher than `specular.max_roughness`: radiance x BRDF x cos / pdf, divided by the surface's
/// specular albedo (rgb), and how far the ray went (w, metres; 10 km where it met nothing, 0 where
/// there was none).
gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer);

}  // namespace heliograph::render
