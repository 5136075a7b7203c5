#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

/// Accumulation of signals over frames on all processors, in the widest vectors that they have.
namespace heliograph::render::kernels {

/// shaders/denoise/visibility_temporal.comp
template <class Stage>
struct TemporalVisibilityBindings {
  gpu::Read<Stage> noisy, guide, reprojection;
  gpu::Read<Stage> previous_history, previous_moments, previous_history_length;
  gpu::Read<Stage> previous_fast_history;
  gpu::Read<Stage> percentiles;  // not by the kernel
  gpu::Write<Stage> signal, history, moments, history_length, fast_history;
};
using TemporalVisibilityJob = FrameJob<TemporalVisibilityBindings, shared::TemporalConstants>;

/// shaders/denoise/specular_temporal.comp
template <class Stage>
struct TemporalSpecularBindings {
  gpu::Read<Stage> noisy, guide, instance, reprojection;
  gpu::Read<Stage> previous_normals, previous_surface, previous_instance;
  gpu::Read<Stage> previous_history, previous_history_length, previous_fast_history;
  gpu::Read<Stage> percentiles;  // not by the kernel
  gpu::Write<Stage> signal, history, history_length, fast_history;
};
using TemporalSpecularJob = FrameJob<TemporalSpecularBindings, shared::TemporalConstants>;

/// shaders/denoise/visibility_rectify.comp and specular_rectify.comp
template <class Stage>
struct RectifyBindings {
  gpu::Read<Stage> guide, fast_history;
  gpu::ReadWrite<Stage> signal, history_length;
  gpu::Write<Stage> history;
};
using RectifyJob = FrameJob<RectifyBindings, shared::TemporalConstants>;

/// shaders/denoise/visibility_feedback.comp
template <class Stage>
struct VisibilityFeedbackBindings {
  gpu::Read<Stage> filtered;
  gpu::Write<Stage> history;
};
using VisibilityFeedbackJob = FrameJob<VisibilityFeedbackBindings>;

/// shaders/denoise/specular_feedback.comp
template <class Stage>
struct SpecularFeedbackBindings {
  gpu::Read<Stage> filtered, fast_history;
  gpu::Write<Stage> history;
};
using SpecularFeedbackJob = FrameJob<SpecularFeedbackBindings>;

/// Whether the kernels know this rectification: those by windows and percentiles of the current
/// frame are left to the shaders.
bool can_accumulate(std::uint32_t rectification);

void visibility_temporal(const TemporalVisibilityJob& job);
void specular_temporal(const TemporalSpecularJob& job);
void visibility_rectify(const RectifyJob& job);
void specular_rectify(const RectifyJob& job);
void visibility_feedback(const VisibilityFeedbackJob& job);
void specular_feedback(const SpecularFeedbackJob& job);

}  // namespace heliograph::render::kernels
