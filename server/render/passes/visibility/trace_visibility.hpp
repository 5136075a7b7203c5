#pragma once

#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

inline constexpr struct VisibilityBuffers {
  BufferDescription shadows{"shadows.visibility", ViewColors::grey,
                            "Fraction of the lights' light that one ray per pixel finds "
                            "unshadowed."};
  BufferDescription ambient{"ambient.visibility", ViewColors::grey,
                            "Fraction of the hemisphere that one ray per pixel finds open."};
} visibility_buffers{};

/// One shadow ray per pixel toward one light chosen by its unshadowed contribution. The result's
/// expectation is sum(L V) / sum(L) over all lights, 0..1 (Heitz et al. 2018). Where a sampling
/// plan is `planned` and leaves a pixel out, -1.
gpu::ImageRef trace_shadows(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned = {});

/// One cosine-distributed ray per pixel of limited length: 1 where the environment is open, -1
/// where the plan leaves a pixel out.
gpu::ImageRef trace_ambient(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned = {});

}  // namespace heliograph::render
