#pragma once

#include "render/passes/post/exposure.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

inline constexpr struct FilterMeanBuffers {
  BufferDescription filtered{"mean.filtered", ViewColors::radiance,
                             "The accumulated mean, filtered by its own noise: linear radiance; "
                             "standard deviation of its luminance (w)."};
} filter_mean_buffers{};

/// The mean as it is shown, rgba16f, of the size that is shown; a: standard deviation of its
/// luminance by noise. With `accumulation.filter` its difference from the denoised frame,
/// `radiance`, is averaged over 7x7 pixels where patches of 3x3 pixels differ by no more than their
/// noise: non-local means (Buades et al. 2005) with the variance of the samples (Rousselle et al.
/// 2012). The more samples there are, the less it changes. Nothing is written in frames that show
/// none of the mean.
gpu::ImageRef filter_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                          gpu::ImageRef radiance, gpu::ImageRef mean);

}  // namespace heliograph::render
