#pragma once

#include <functional>
#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

inline constexpr struct ComposeBuffers {
  BufferDescription hdr{"hdr", ViewColors::radiance,
                        "The frame's radiance, denoised, before antialiasing: linear."};
  BufferDescription noisy{"hdr.noisy", ViewColors::radiance,
                          "The frame's radiance from the noisy signals: linear."};
} compose_buffers{};

/// The signals of this frame's rays.
struct NoisySignals {
  gpu::ImageRef shadows;                  // r32f
  gpu::ImageRef ambient;                  // r32f
  std::optional<gpu::ImageRef> specular;  // rgba32f; without it the environment is reflected
  std::optional<gpu::ImageRef> indirect;  // rgba32f; without it the environment shines around
};

/// The same without noise, in 32 or 16 bits a channel; a signal that is not denoised stands here as
/// it is.
struct DenoisedSignals {
  gpu::ImageRef visibility;               // shadow x, ambient y
  std::optional<gpu::ImageRef> specular;  // rgb
  std::optional<gpu::ImageRef> indirect;  // rgb
};

/// Linear radiance.
struct Composed {
  gpu::ImageRef hdr;
  gpu::ImageRef noisy;  // from the noisy signals; the same image where nothing is denoised
  std::function<bool()> makes_noisy{};  // frames in which that has content; empty: all of them
};

/// Frames in which compose() does more than what is shown needs; empty: all of them.
struct ComposeConditions {
  /// The background is an image; in other frames it is what draw_skybox() would have drawn.
  std::function<bool()> has_background;
  /// The noisy radiance is made.
  std::function<bool()> makes_noisy;
};

/// Analytic direct light x traced visibility + reflections + image based light + emission over the
/// background (paper section 3, stage 7).
Composed compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const NoisySignals& signals, const std::optional<DenoisedSignals>& denoised,
                 gpu::ImageRef background, const ComposeConditions& when = {});

}  // namespace heliograph::render
