#pragma once

#include <array>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/views/aspects.hpp"

namespace heliograph::render {

struct FrameInputs;

inline constexpr std::array accumulate_mean_aspects{
    Aspect{"stops", ViewColors::stops, 1, exposure_stops,
           "Luminance as exposed, in stops from middle grey.", "EV"}};

inline constexpr struct AccumulateBuffers {
  BufferDescription mean{.name = "accumulated",
                         .colors = ViewColors::radiance,
                         .description =
                             "The mean of all samples since the view last changed: "
                             "linear radiance.",
                         .aspects = accumulate_mean_aspects};
} accumulate_buffers{};

/// The mean of every frame's `sample` since the view last changed: linear radiance.
gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample);

/// The weight of the mean in the image that this frame shows, 0..1. While the view moves, the
/// denoised frame is shown; the longer the view is static, the more the mean, which converges to
/// the ground truth. `accumulation.blend_samples` samples after the first both weigh the same. 0 in
/// frames that are drawn smaller than they are shown, as the mean is.
float mean_weight(const FrameInputs& in);

}  // namespace heliograph::render
