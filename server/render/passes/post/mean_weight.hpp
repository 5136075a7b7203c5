#pragma once

#include "render/passes/post/exposure.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

inline constexpr struct MeanWeightBuffers {
  BufferDescription weight{"mean_weight", ViewColors::fraction,
                           "Weight of the accumulated mean in the finished frame, 0..1."};
} mean_weight_buffers{};

/// What the mean of all samples weighs in the image that this frame shows, by their number alone,
/// 0..1: the denoised frame is shown while the view moves, and `accumulation.blend_samples` samples
/// after the first weigh as much. 0 in frames that are drawn smaller than they are shown.
float mean_share(const FrameInputs& in);

/// Whether the mean has any weight in some pixel of this frame.
bool weighs_mean(const FrameInputs& in);
/// Whether it depends on noise, pixel by pixel.
bool weighs_by_noise(const FrameInputs& in);

/// The weight of `mean`, which filter_mean() made, in every pixel: r32f, of the size that is shown.
/// With `accumulation.by_noise` the mean
/// is shown where it differs from the denoised frame, `radiance`, by more than its noise explains:
/// the weight of least squared error, for independent errors (as of James and Stein 1961, in
/// windows of 5x5 pixels). It converges to the mean, wherever the denoised frame does not do so
/// itself.
gpu::ImageRef weigh_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                         gpu::ImageRef radiance, gpu::ImageRef mean);

}  // namespace heliograph::render
