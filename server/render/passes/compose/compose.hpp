#pragma once

#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// What this frame's rays found.
struct RawSignals {
  gpu::ImageRef shadows;                  // r32f
  gpu::ImageRef ambient;                  // r32f
  std::optional<gpu::ImageRef> specular;  // rgba32f; without it the environment is mirrored
};

/// The same without noise; a signal that is not denoised stands here as it is.
struct DenoisedSignals {
  gpu::ImageRef visibility;               // rgba32f: shadow x, ambient y
  std::optional<gpu::ImageRef> specular;  // rgba32f
};

/// Linear radiance.
struct Composed {
  gpu::ImageRef hdr;
  gpu::ImageRef hdr_raw;  // from the raw signals; the same image where nothing is denoised
};

/// Analytic direct light x traced visibility + mirrored light + image based light + emission over
/// the background (paper section 3, stage 7).
Composed compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const RawSignals& raw, const std::optional<DenoisedSignals>& denoised,
                 gpu::ImageRef background);

}  // namespace heliograph::render
