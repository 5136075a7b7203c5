#include "session/inspection/frame_view.hpp"

#include <cmath>

#include "scene/animation/explosion.hpp"
#include "scene/camera/camera.hpp"

namespace heliograph::session {
namespace {

const scene::Clip* clip_of(const RenderState& state) {
  return scene::find_clip(*state.scene, state.animation.clip);
}

scene::Camera camera_of(const RenderState& state) {
  if (!state.camera_follows) return state.camera;
  const double seconds = state.animation.at(state.now());
  return scene::camera_at(*state.scene, state.camera,
                          scene::pose_at(*state.scene, clip_of(state), seconds));
}

}  // namespace

FrameView::FrameView(const RenderState& state)
    : pose_(scene::shown_pose(*state.scene, clip_of(state), state.animation.at(state.now()),
                              state.settings.view.explode)),
      camera_(camera_of(state)),
      forward_(glm::normalize(camera_.target - camera_.eye)),
      aspect_(static_cast<float>(state.width) / static_cast<float>(state.height)) {}

glm::vec3 FrameView::direction_to(const glm::vec3& point) const {
  return camera_.orthographic_height > 0.0f ? forward_ : glm::normalize(point - camera_.eye);
}

float FrameView::distance_to(const glm::vec3& point) const {
  const glm::vec3 offset = point - camera_.eye;
  return camera_.orthographic_height > 0.0f ? glm::dot(offset, forward_) : glm::length(offset);
}

float FrameView::height_at(const glm::vec3& point) const {
  if (camera_.orthographic_height > 0.0f) return camera_.orthographic_height;
  const float depth = glm::dot(point - camera_.eye, forward_);
  return 2.0f * depth * std::tan(0.5f * glm::radians(camera_.vertical_fov));
}

std::optional<glm::vec2> FrameView::image_point(const glm::vec3& point) const {
  const glm::vec4 seen = scene::view_matrix(camera_) * glm::vec4(point, 1.0f);
  if (seen.z >= 0.0f) return std::nullopt;
  const glm::vec4 clip = scene::projection_matrix(camera_, aspect_) * seen;
  const glm::vec2 place = 0.5f + 0.5f * glm::vec2(clip) / clip.w;
  const bool within = place.x >= 0.0f && place.y >= 0.0f && place.x <= 1.0f && place.y <= 1.0f;
  return within ? std::optional(place) : std::nullopt;
}

}  // namespace heliograph::session
