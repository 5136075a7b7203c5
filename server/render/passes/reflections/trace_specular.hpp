#pragma once

#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/indirect/radiance_cache.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

inline constexpr std::array specular_radiance_aspects{Aspect{
    "distance", ViewColors::distance, 1, one_channel<3>,
    "Distance from the surface to what it reflects, metres; 10000: the environment.", "metres"}};

inline constexpr struct SpecularBuffers {
  BufferDescription radiance{
      .name = "specular.radiance",
      .colors = ViewColors::radiance,
      .description =
          "Radiance of one reflected ray per pixel, demodulated; its length in metres "
          "(w).",
      .aspects = specular_radiance_aspects};
  BufferDescription half_radiance{"specular.half.radiance", ViewColors::radiance,
                                  "Radiance of one reflected ray per 2x2 pixels, demodulated; its "
                                  "length in metres (w)."};
  BufferDescription half_directions{"specular.half.directions", ViewColors::direction,
                                    "Directions of the reflected rays, world space; their density "
                                    "per solid angle (w)."};
} specular_buffers{};

/// What the specular lobe sees of the scene and the environment, one ray per pixel of a surface not
/// rougher than `specular.max_roughness`: radiance x BRDF x cos / pdf, divided by the surface's
/// specular albedo (rgb), and how far the ray went (w, metres; 10 km where it met nothing, 0 where
/// there was none). Where a sampling plan is `planned` and leaves a pixel out, w is the distance of
/// the frame before, negated. `visibility` of the frame before, shadow in x, takes the place of
/// shadow rays from hits that it showed. With a `cache` hits take their indirect light from it,
/// otherwise the environment's as if nothing hid it.
gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             std::optional<gpu::ImageRef> planned = {},
                             std::optional<gpu::ImageRef> visibility = {},
                             const std::optional<RadianceCache>& cache = {});

/// Radiance along `rays` of surfaces before those of the G-buffer `behind`, each with its weight:
/// stored in `radiance` at the rays' pixels. `surface` holds the roughness that they come from,
/// `distance` how far from the eye that is (a; metres). `cache`: as above.
void trace_reflections(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                       const tracing::RayStream& rays, const GBuffer& behind, gpu::ImageRef surface,
                       gpu::ImageRef distance, gpu::ImageRef radiance,
                       const std::optional<RadianceCache>& cache = {});

/// Adds what `rays` carry to `radiance`, at the pixels of those that are not occluded.
void add_unoccluded_light(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                          const tracing::RayStream& rays, gpu::ImageRef radiance);

}  // namespace heliograph::render
