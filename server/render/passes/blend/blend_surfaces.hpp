#pragma once

#include "render/kernels/blend/blended.hpp"
#include "render/passes/compose/compose.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/indirect/radiance_cache.hpp"
#include "render/resources/moving/moving_scene.hpp"

namespace heliograph::render {

inline constexpr struct BlendedBuffers {
  BufferDescription radiance{"blended.radiance", ViewColors::radiance,
                             "Light of blended surfaces, as much as reaches the eye; linear."};
  BufferDescription transmittance{"blended.transmittance", ViewColors::channels,
                                  "Transmittance of all blended surfaces of a pixel together."};
  BufferDescription motion{"blended.motion", ViewColors::difference,
                           "Like gbuffer.motion, of the surface that contributes most."};
  BufferDescription specular{"blended.specular", ViewColors::radiance,
                             "Radiance of one reflected ray per pixel from blended surfaces; "
                             "linear."};
  BufferDescription surface{"blended.surface", ViewColors::channels,
                            "Perceptual roughness and metalness of the blended surface that rays "
                            "light."};
} blended_buffers{};

/// How many blended surfaces behind each other a pixel shows; the nearest ones.
inline constexpr std::uint32_t most_blended = 6;

/// What the passes of blended surfaces fill.
struct BlendedImages {
  gpu::ImageRef radiance;       // a: of all weights, the sum
  gpu::ImageRef transmittance;  // a: of the chosen surface, its weight, then view Z
  gpu::ImageRef motion;
  gpu::ImageRef specular;
  gpu::ImageRef surface;
  gpu::BufferRef chosen;  // shared::Hit of each pixel
};
BlendedImages declare_blended(gpu::FramePlan& plan);

inline bool has_blends(const FrameInputs& in) {
  return (in.moving.features_without_emission() & shared::scene_blends) != 0;
}

/// Whether surfaces may show what is behind them along rays of their own.
bool bends_light(const FrameInputs& in);

/// What host kernels light surfaces with. `lights`, of this frame, outlive it.
kernels::LitScene lit_scene(const FrameInputs& in, std::span<const shared::Light> lights);

/// Blends the scene's blended surfaces over the composed frame, in place: glTF's alphaMode BLEND
/// and what lets light through. They are found from front to back between the camera and the
/// G-buffer's surfaces, by rays through the pixels or by the host's rasteriser (draw_gbuffer), so
/// that no order of drawing matters. They are lit as others are, by one ray of each kind in every
/// pixel, without a denoiser; rough ones reflect fewer in frames that leave samples out. What is
/// behind volumes and rough thin walls that let light through shows along one refracted ray.
/// @param cache where indirect light comes from; without one it is the environment's, as far as
/// ambient occlusion lets it through
/// @param drawn what draw_gbuffer has filled; otherwise rays find the surfaces
/// @return motion vectors of the visible surface: the first that covers more than half of what is
/// behind it
gpu::ImageRef blend_surfaces(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const Composed& composed, const std::optional<RadianceCache>& cache,
                             const BlendedImages* drawn = nullptr);

}  // namespace heliograph::render
