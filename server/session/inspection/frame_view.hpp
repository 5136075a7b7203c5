#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <utility>

#include "scene/animation/pose.hpp"
#include "session/state/render_state.hpp"

namespace heliograph::session {

/// The camera of a frame as the ray or the place in the image of points of the world.
class FrameView {
 public:
  explicit FrameView(const RenderState& state) : FrameView(state, state.now()) {}
  /// As of a moment, which counts while a clip plays.
  FrameView(const RenderState& state, Clock::time_point moment);

  const scene::Pose& pose() const { return pose_; }
  /// Toward a point, unit length: from the eye, or along the view without perspective.
  glm::vec3 direction_to(const glm::vec3& point) const;
  /// As SurfacePoint::distance has it.
  float distance_to(const glm::vec3& point) const;
  /// Height of what the image shows at the depth of a point, metres.
  float height_at(const glm::vec3& point) const;
  /// In fractions of the image from the top left corner; empty: not within the image.
  std::optional<glm::vec2> image_point(const glm::vec3& point) const;
  /// The part of a line before the eye, without what lies far outside of the image; empty: none.
  std::optional<std::pair<glm::vec2, glm::vec2>> image_line(const glm::vec3& from,
                                                            const glm::vec3& to) const;

 private:
  scene::Pose pose_;
  scene::Camera camera_;
  glm::vec3 forward_;
  float aspect_;  // width / height
};

}  // namespace heliograph::session
