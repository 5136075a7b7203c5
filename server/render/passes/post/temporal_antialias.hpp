#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/post/exposure.hpp"

namespace heliograph::render {

inline constexpr struct TemporalAntialiasBuffers {
  BufferDescription resolved{"temporal_antialias", ViewColors::radiance,
                             "The frame blended with those before it (temporal antialiasing): "
                             "linear radiance."};
} temporal_antialias_buffers{};

/// Blends each frame with those before along the motion of surfaces and of the background: linear
/// radiance without jitter (paper section 3, stage 8; the box of Salvi 2016).
/// A frame that is drawn smaller than it is shown is reconstructed from its jittered samples (the
/// structure of Snapdragon GSR 2). `radiance` itself where `antialiasing.temporal` is off.
gpu::ImageRef temporal_antialias(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Exposure& exposure,
                                 gpu::ImageRef radiance);

}  // namespace heliograph::render
