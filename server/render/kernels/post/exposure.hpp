#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

/// Metering and adaptation of exposure.
namespace heliograph::render::kernels {

/// shaders/post/exposure_begin.comp
template <class Stage>
struct ExposureBeginBindings {
  gpu::WriteBuffer<Stage, std::uint32_t> histogram;  // shared::exposure_bins
};
using ExposureBeginJob = gpu::HostPass<ExposureBeginBindings>;
void exposure_begin(const ExposureBeginJob& job);

/// shaders/post/exposure_meter.comp
template <class Stage>
struct ExposureMeterBindings {
  gpu::Read<Stage> hdr, mean;  // rgba32f
  gpu::ReadWriteBuffer<Stage, std::uint32_t> histogram;
};
struct ExposureMeterConstants {
  float mean_weight;  // of the accumulated mean in the image that is shown, 0..1
};
using ExposureMeterJob = gpu::HostPass<ExposureMeterBindings, ExposureMeterConstants>;

/// Adds every second pixel of every second row to the histogram, on all processors.
void exposure_meter(const ExposureMeterJob& job);

/// shaders/post/exposure_adapt.comp
template <class Stage>
struct ExposureAdaptBindings {
  gpu::ReadBuffer<Stage, std::uint32_t> histogram;
  gpu::ReadWriteBuffer<Stage, shared::ExposureState> state;
  gpu::WriteBuffer<Stage, shared::ExposureState> report;
};
struct ExposureAdaptConstants {
  float seconds;     // since the frame before
  float adaptation;  // seconds in which 1 - 1/e of a change is followed
  float reach;       // stops away from manual exposure, at most; 0: it is manual
};
using ExposureAdaptJob = FrameJob<ExposureAdaptBindings, ExposureAdaptConstants>;
void exposure_adapt(const ExposureAdaptJob& job);

}  // namespace heliograph::render::kernels
