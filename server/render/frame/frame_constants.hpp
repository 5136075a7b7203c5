#pragma once

#include <array>

#include "gpu/memory/buffer.hpp"
#include "gpu/memory/image.hpp"
#include "protocol/settings/settings.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render {

class MovingScene;

/// Offset of a sample inside its pixel, in pixels from the middle: sample 0 is the middle, the
/// rest follow the R2 sequence (Roberts 2018).
glm::vec2 sample_jitter(std::uint32_t sample);

/// Sizes of a frame, pixels: as it is drawn, and as it is shown.
struct FrameSizes {
  VkExtent2D drawn, shown;
};

/// The frame's uniform block for `sample` of a static view. The previous matrices are taken from
/// `before`, which is this view's block of the frame before (or null for the first).
shared::FrameConstants make_frame_constants(const scene::Camera& camera,
                                            const protocol::Settings& settings,
                                            const MovingScene& scene, const FrameSizes& sizes,
                                            std::uint32_t sample,
                                            const shared::FrameConstants* before);

/// Of the same frame with one texel for each square of 2x2 pixels, also for those that the border
/// cuts: a texel is seen at the middle of its square.
shared::FrameConstants at_half_size(const shared::FrameConstants& frame);

/// The uniform blocks of a frame for the device.
struct FrameConstantsBuffers {
  explicit FrameConstantsBuffers(const gpu::Device& device);
  void upload(const shared::FrameConstants& constants,
              const shared::FrameConstants& half_constants);

  gpu::Buffer whole;
  gpu::Buffer half;  // at_half_size()
};

/// By gpu::FramePlan::slot().
using FrameConstantsSlots = std::array<FrameConstantsBuffers, 2>;

}  // namespace heliograph::render
