#pragma once

#include <algorithm>

#include "shaders/shared/frame_constants.h"

namespace heliograph::render {

class MovingScene;

/// Motion since the frame before, the camera's aside.
struct SceneMotion {
  /// How far lights moved, in widths of their own: 0 while all are static, 1 where each moved by
  /// its whole width or more. A mean, weighted by each light's irradiance at the middle of the
  /// scene.
  float lights = 0.0f;
  float environment = 0.0f;         // rotation, radians
  bool geometry_moved = false;      // whether any instance moved or any mesh deformed
  bool brightness_changed = false;  // of any light or of the environment
  /// Frames since any of these last was not as in the frame before; 0: they are not now.
  std::uint32_t still_frames = ~0u;
  /// The same of lights and the environment alone: what changes all indirect light.
  std::uint32_t still_light_frames = ~0u;

  bool light_changes() const { return lights > 0.0f || environment > 0.0f || brightness_changed; }
  bool any() const { return light_changes() || geometry_moved; }
  /// Whether histories hold no more traces of what moved or changed.
  bool settled() const { return still_frames >= settling_frames; }
  /// How many of the last `age` frames had the light of this frame; all of them where it changes in
  /// this frame, too: then no frame has.
  std::uint32_t frames_of_light(std::uint32_t age) const {
    return still_light_frames > 0 ? std::min(age, still_light_frames) : age;
  }

  static constexpr std::uint32_t settling_frames = 32;
};

/// `before` is null in the first frame.
SceneMotion scene_motion(const MovingScene& scene, const shared::FrameConstants& now,
                         const shared::FrameConstants* before);

/// Length of the history, in frames, of a signal whose light moves by `motion` of its width each
/// frame. A mean over N frames lags by (N - 1) x motion, and its noise falls as 1 / (2 N - 1): the
/// sum of both squares is least near N = 1 + 0.63 (motion^(-2/3) - 1); the factor is measured, with
/// the blur after it.
float frames_under_motion(float motion);

}  // namespace heliograph::render
