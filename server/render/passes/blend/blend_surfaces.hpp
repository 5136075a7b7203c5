#pragma once

#include "render/passes/compose/compose.hpp"

namespace heliograph::render {

struct FrameInputs;

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

/// Blends the scene's blended surfaces over the composed frame, in place: glTF's alphaMode BLEND
/// and what lets light through. Rays through the pixels find them from front to back between the
/// camera and the G-buffer's surfaces, so that no order of drawing matters. They are lit as others
/// are, by one ray of each kind in every pixel, without a denoiser.
/// @return motion vectors of the visible surface: the first that covers more than half of what is
/// behind it
gpu::ImageRef blend_surfaces(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const Composed& composed);

}  // namespace heliograph::render
