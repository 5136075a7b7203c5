#pragma once

#include <array>
#include <functional>
#include <optional>

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
                             "linear radiance; variance of a single sample's luminance (w).",
                         .aspects = accumulate_mean_aspects};
} accumulate_buffers{};

/// The mean of every frame's `sample` since the view last changed: linear radiance, and in w the
/// variance of their luminance (Welford 1962). `traced` is the reference's sample, whose
/// mean replaces the other where traces_reference().
/// @param when  frames that need the mean; empty: all do
gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample,
                        const std::function<bool()>& when = {},
                        std::optional<gpu::ImageRef> traced = {});

/// How many samples that is, with this frame's.
std::uint32_t samples_of_mean(const FrameInputs& in);

}  // namespace heliograph::render
