#pragma once

#include "render/passes/post/exposure.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

inline constexpr struct PresentBuffers {
  BufferDescription output{"output", ViewColors::output, "The finished frame."};
  /// No image: made from those that present() reads where it is asked for.
  BufferDescription radiance{"output.radiance", ViewColors::radiance,
                             "The finished frame before exposure and tone mapping: linear."};
} present_buffers{};

/// The frame and the mean of its samples by the weights of weigh_mean(), exposure, tone map, sRGB:
/// RGBA8 for encoders (paper section 3, stage 9).
gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                      gpu::ImageRef radiance, gpu::ImageRef mean, gpu::ImageRef mean_weight);

}  // namespace heliograph::render
