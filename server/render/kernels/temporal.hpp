#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/denoise.h"
#include "shaders/shared/frame_constants.h"

/// Gathering signals over frames on all processors, in the widest vectors that the processor has.
namespace heliograph::render::kernels {

struct TemporalVisibilityJob {
  const shared::FrameConstants& frame;
  shared::TemporalConstants constants;
  int width;
  int height;
  gpu::HostView raw, guide, reprojection;
  gpu::HostView previous_signal, previous_moments, previous_history, previous_fast;
  gpu::HostView signal, moments, history, fast;  // written
};

struct TemporalSpecularJob {
  const shared::FrameConstants& frame;
  shared::TemporalConstants constants;
  int width;
  int height;
  gpu::HostView raw, guide, instance, reprojection;
  gpu::HostView previous_normals, previous_surface, previous_motion, previous_instance;
  gpu::HostView previous_signal, previous_history, previous_fast;
  gpu::HostView signal, history, fast;  // written
};

struct RectifyJob {
  shared::TemporalConstants constants;
  int width;
  int height;
  gpu::HostView guide, fast;
  gpu::HostView signal, history;  // read and written
};

/// Whether the kernels know the rectification that these constants ask for: those by windows and
/// percentiles of the current frame are left to the shaders.
bool can_accumulate(std::uint32_t rectification);

/// shaders/denoise/visibility_temporal.comp
void accumulate_visibility(const TemporalVisibilityJob& job);
/// shaders/denoise/specular_temporal.comp
void accumulate_specular(const TemporalSpecularJob& job);
/// shaders/denoise/visibility_rectify.comp
void rectify_visibility(const RectifyJob& job);
/// shaders/denoise/specular_rectify.comp
void rectify_specular(const RectifyJob& job);

}  // namespace heliograph::render::kernels
