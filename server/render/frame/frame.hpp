#pragma once

#include <optional>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/indirect/radiance_cache.hpp"
#include "render/passes/post/exposure.hpp"

namespace heliograph::render {

/// The buffers that outlive the frame or leave it.
struct FrameOutputs {
  gpu::History accumulated;  // linear radiance
  Exposure exposure;
  gpu::ImageRef radiance;     // of the frame alone, as present() reads it
  gpu::ImageRef mean;         // what is accumulated, filtered
  gpu::ImageRef mean_weight;  // of the latter in what is shown
  gpu::ImageRef output;       // sRGB, RGBA8
  std::optional<RadianceCache> radiance_cache{};
};

/// Whether nothing of this frame is read but what it shows: its noisy radiance is no part of a
/// mean, and its buffers are not asked for. Some of them have no content then.
bool is_only_shown(const FrameInputs& in);

/// Declares all passes of a frame, in order.
FrameOutputs declare_frame(gpu::FramePlan& plan, const FrameInputs& in);

}  // namespace heliograph::render
