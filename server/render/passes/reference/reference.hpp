#pragma once

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

struct FrameInputs;

inline constexpr struct ReferenceBuffers {
  BufferDescription radiance{"reference", ViewColors::radiance,
                             "One sample of the path tracer: linear radiance."};
} reference_buffers{};

/// Whether this frame's sample is path traced: with `when_static` after those of the hybrid.
bool traces_reference(const FrameInputs& in);

/// One sample per pixel of the ground truth, as settings.reference asks for it: the hybrid's own
/// light paths or full global illumination, from the camera's ray on by nothing but traced rays.
/// Its surfaces, lights, BRDF, camera and random numbers are the hybrid's; its code is not. Linear
/// radiance; the mean over frames converges to the integral over the pixel. `ground`: what
/// trace_ground() has found, for shadows over the background.
gpu::ImageRef trace_reference(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground);

}  // namespace heliograph::render
