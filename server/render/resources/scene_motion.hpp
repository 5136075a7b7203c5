#pragma once

#include "shaders/shared/frame_constants.h"

namespace heliograph::render {

class MovingScene;

/// What went on since the frame before, the camera aside.
struct SceneMotion {
  /// How far they went, in widths of their own: 0 while all rest, 1 where each went by its whole
  /// width or more. A mean, weighed by what each light sends to the middle of the scene.
  float lights = 0.0f;
  float environment = 0.0f;  // how far it turned, radians
  bool things = false;       // whether anything moved or changed its shape
};

/// `before` is null where no frame went before.
SceneMotion scene_motion(const MovingScene& scene, const shared::FrameConstants& now,
                         const shared::FrameConstants* before);

/// How many frames of a signal to remember whose light moves by `motion` of its width each frame. A
/// mean over N frames lags by (N - 1) x motion, and its noise falls as 1 / (2 N - 1): the sum of
/// both squares is least near N = 1 + 0.63 (motion^(-2/3) - 1); the factor is measured, with the
/// blur behind it.
float frames_under_motion(float motion);

}  // namespace heliograph::render
