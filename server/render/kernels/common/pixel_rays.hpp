#pragma once

#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// Toward what a pixel's sample shows, world space; the direction has any length.
struct PixelRay {
  glm::vec3 origin;
  glm::vec3 direction;
};

/// The rays of a frame, one at a time.
class PixelRays {
 public:
  explicit PixelRays(const shared::FrameConstants& frame)
      : frame_(frame),
        orthographic_((frame.flags & shared::frame_orthographic) != 0),
        scale_(2.0f / glm::vec2(frame.extent)) {}

  PixelRay through(int x, int y) const {
    const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) * scale_ - 1.0f;
    const glm::vec4& u = frame_.unproject;
    const glm::vec2 slope = ndc * glm::vec2(u.x, u.y) + glm::vec2(u.z, u.w);
    const glm::vec3 away = orthographic_ ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(slope, -1.0f);
    const glm::vec3 view_origin = orthographic_ ? glm::vec3(slope, 0.0f) : glm::vec3(0.0f);
    return {glm::vec3(frame_.inverse_view * glm::vec4(view_origin, 1.0f)),
            glm::mat3(frame_.inverse_view) * away};
  }

 private:
  const shared::FrameConstants& frame_;
  bool orthographic_;
  glm::vec2 scale_;
};

}  // namespace heliograph::render::kernels
