#pragma once

#include <algorithm>

#include "render/passes/frame_inputs.hpp"
#include "render/resources/moving/scene_motion.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render {

static_assert(static_cast<shared::uint>(protocol::Rectification::variance_clamp) ==
              shared::rectification_variance_clamp);
static_assert(static_cast<shared::uint>(protocol::Rectification::gradient) ==
              shared::rectification_gradient);

/// How much wider the box of rectification becomes while the view is static: nothing changes any
/// more, and clamping a long history to noise would keep it from converging. The paper's boxes stay
/// as they are.
inline float static_box_scale(const FrameInputs& in, protocol::Rectification mode) {
  const bool widens =
      mode == protocol::Rectification::fast_history || mode == protocol::Rectification::percentile;
  constexpr float settled = 8.0f;  // samples after which the history holds no motion
  return widens ? std::max(1.0f, static_cast<float>(in.clock.samples) / settled) : 1.0f;
}

/// What the passes of one signal's accumulation read, this frame. The history's length is counted
/// in seconds, so that it does not depend on the frame rate, and grows while the view is static, so
/// that it converges.
inline shared::TemporalConstants temporal_constants(const FrameInputs& in,
                                                    const protocol::TemporalSettings& settings) {
  const auto static_frames = static_cast<float>(in.clock.samples + 1);
  const float by_time =
      in.clock.seconds > 0.0f ? settings.history_seconds / in.clock.seconds : 0.0f;
  shared::TemporalConstants constants{};
  const float carried = std::max(static_cast<float>(settings.history_frames), by_time);
  constants.frames = std::max(carried, static_frames);
  // What frames of fewer pixels have left counts as so many samples, or it would blur for long.
  if (in.clock.samples > 0 && in.clock.carried_share < 1.0f) {
    constants.frames = in.clock.carried_share * carried + static_frames;
  }
  constants.moments_frames = std::max(static_cast<float>(settings.moments_frames), static_frames);
  constants.rectification = static_cast<std::uint32_t>(settings.rectification);
  constants.radius = settings.rectification_radius;
  constants.scale = settings.rectification_scale * static_box_scale(in, settings.rectification);
  if (settings.rectification == protocol::Rectification::gradient) {
    // Of the mean: the neighbourhood's samples are independent of each other.
    constants.scale /= static_cast<float>(2 * settings.rectification_radius + 1);
  }
  if (settings.follow_lights) {
    constants.light_frames = frames_under_motion(in.scene_motion.lights);
    constants.environment_turn = in.scene_motion.environment;
  } else {
    constants.light_frames = constants.frames;
  }
  constants.spatial_variance_frames = static_cast<float>(settings.spatial_variance_frames);
  const bool holds = settings.enabled && in.constants.history_invalid == 0;
  constants.flags = (holds ? shared::temporal_history_valid : 0u) |
                    (settings.mean_variance ? shared::temporal_mean_variance : 0u) |
                    (settings.bicubic ? shared::temporal_bicubic : 0u);
  return constants;
}

/// One pass of an iteration: both halves of the kernel at once, or one of two.
struct KernelShape {
  int level = 0;
  int columns = 0;
  int rows = 0;
  bool first_half = false;
  int pixels_per_texel = 1;  // of the images, along each axis
};

/// Whether the result of an iteration becomes the history of the next frame.
inline bool feeds_back(const protocol::BlurSettings& settings) {
  return settings.enabled && settings.feedback >= 0 && settings.feedback < settings.iterations;
}

inline shared::AtrousConstants atrous_constants(const protocol::BlurSettings& settings,
                                                const SceneMotion& motion,
                                                const KernelShape& shape) {
  shared::AtrousConstants constants{};
  constants.level = shape.level;
  constants.columns = shape.columns;
  constants.rows = shape.rows;
  constants.luminance_sigma = motion.settled() ? settings.luminance_sigma : settings.moving_sigma;
  constants.normal_power = settings.normal_power;
  constants.depth_sigma = settings.depth_sigma;
  constants.pixels_per_texel = shape.pixels_per_texel;
  const bool keep =
      shape.first_half && settings.variance_update == protocol::VarianceUpdate::vertical_only;
  constants.flags = (settings.variance_prefilter ? shared::atrous_variance_prefilter : 0u) |
                    (keep ? shared::atrous_keep_variance : 0u) |
                    (settings.jitter ? shared::atrous_jitter : 0u);
  return constants;
}

}  // namespace heliograph::render
