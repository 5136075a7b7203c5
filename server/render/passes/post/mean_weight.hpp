#pragma once

#include <optional>

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

/// The weight of the mean in this frame, where all pixels have the same; absent where it depends on
/// noise, pixel by pixel.
std::optional<float> uniform_mean_weight(const FrameInputs& in);
/// That as a constant of passes that read the weight: below 0 where the image has it.
float uniform_weight_constant(const FrameInputs& in);

/// Whether the mean has any weight in some pixel of this frame.
bool weighs_mean(const FrameInputs& in);
/// Whether it depends on noise as soon as that is known, pixel by pixel.
bool weighs_by_noise(const FrameInputs& in);

/// The weight of `mean`, which filter_mean() made, in every pixel: r32f, of the size that is shown.
/// It has no defined content in frames with a uniform_mean_weight().
/// With `accumulation.by_noise` the mean
/// is shown where it differs from the denoised frame, `radiance`, by more than its noise explains:
/// the weight of least squared error, for independent errors (as of James and Stein 1961, in
/// windows of 5x5 pixels). It converges to the mean, wherever the denoised frame does not do so
/// itself.
gpu::ImageRef weigh_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                         gpu::ImageRef radiance, gpu::ImageRef mean);

}  // namespace heliograph::render
