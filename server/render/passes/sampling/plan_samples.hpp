#pragma once

#include <array>
#include <optional>

#include "render/passes/denoise/reproject.hpp"
#include "shaders/shared/sampling.h"

namespace heliograph::render {

/// 1 where the plan's word has a bit.
template <std::uint32_t bit>
glm::vec4 planned_bit(const BufferTexel& texel, const ViewContext&) {
  return scalar((static_cast<std::uint32_t>(texel.value.x) & bit) != 0 ? 1.0f : 0.0f);
}

inline constexpr std::array sampling_plan_aspects{
    Aspect{"shadows", ViewColors::mark, 1, planned_bit<shared::plan_shadows>,
           "Where shadow rays are traced in this frame: 1."},
    Aspect{"ambient", ViewColors::mark, 1, planned_bit<shared::plan_ambient>,
           "Where ambient rays are traced in this frame: 1."},
    Aspect{"specular", ViewColors::mark, 1, planned_bit<shared::plan_specular>,
           "Where reflections are traced in this frame: 1."}};

inline constexpr struct SamplingPlanBuffers {
  BufferDescription plan{
      .name = "sampling.plan",
      .colors = ViewColors::identity,
      .description = "Which rays each pixel traces in this frame, if the view moves.",
      .aspects = sampling_plan_aspects};
} sampling_plan_buffers{};

/// What the plan is made from: lengths of histories and distances of reflections one frame ago.
struct PreviousSamples {
  gpu::ImageRef visibility_length;
  gpu::ImageRef specular_length;
  gpu::ImageRef specular_distance;               // in w
  gpu::ImageRef visibility;                      // shadow and ambient; variances in zw
  std::optional<gpu::ImageRef> indirect_length;  // of indirect.half_resolution, or the frame's size
};

/// Whether this frame of a moving view leaves samples out. It is no part of the accumulated mean,
/// which a static view converges to: that holds a sample of every pixel in every frame.
bool leaves_samples_out(const FrameInputs& in);

/// Whether it leaves out shadow and ambient rays because nothing changes under their histories.
bool leaves_visibility_out(const FrameInputs& in);

/// Decides for every pixel which rays it traces, in words as in shaders/shared/sampling.h, in
/// frames that leave samples out. Surfaces with a short history are sampled in every frame, others
/// in turn; all of them while lights, geometry or brightness change, under whose long histories
/// shadows and reflections would stay.
gpu::ImageRef plan_samples(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                           const Guide& guide, const PreviousSamples& previous);

}  // namespace heliograph::render
