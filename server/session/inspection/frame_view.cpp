#include "session/inspection/frame_view.hpp"

#include <algorithm>
#include <cmath>

#include "scene/animation/explosion.hpp"
#include "scene/camera/camera.hpp"

namespace heliograph::session {
namespace {

const scene::Clip* clip_of(const RenderState& state) {
  return scene::find_clip(*state.scene, state.animation.clip);
}

scene::Camera camera_of(const RenderState& state, double seconds) {
  if (!state.camera_follows) return state.camera;
  return scene::camera_at(*state.scene, state.camera, clip_of(state), seconds);
}

}  // namespace

FrameView::FrameView(const RenderState& state, Clock::time_point moment)
    : pose_(scene::shown_pose(*state.scene, clip_of(state), state.animation.at(moment),
                              state.settings.view.explode)),
      camera_(camera_of(state, state.animation.at(moment))),
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

std::optional<std::pair<glm::vec2, glm::vec2>> FrameView::image_line(const glm::vec3& from,
                                                                     const glm::vec3& to) const {
  constexpr float nearest = 1e-4f;  // of the distance to the target
  constexpr float reach = 3.0f;     // of the image's sides from its centre, halves of them
  const glm::vec4 a = scene::view_matrix(camera_) * glm::vec4(from, 1.0f);
  const glm::vec4 b = scene::view_matrix(camera_) * glm::vec4(to, 1.0f);
  const glm::mat4 projection = scene::projection_matrix(camera_, aspect_);
  const glm::vec4 clip_a = projection * a, clip_b = projection * b;
  const float near_plane = nearest * glm::length(camera_.target - camera_.eye);
  float begin = 0.0f, end = 1.0f;  // of the line, what remains of it
  const auto cut = [&](float inside_a, float inside_b) {
    if (inside_a < 0.0f && inside_b < 0.0f) end = -1.0f;
    if (inside_a < 0.0f && inside_b >= 0.0f)
      begin = std::max(begin, inside_a / (inside_a - inside_b));
    if (inside_a >= 0.0f && inside_b < 0.0f) end = std::min(end, inside_a / (inside_a - inside_b));
  };
  cut(-a.z - near_plane, -b.z - near_plane);
  for (int axis = 0; axis < 2; ++axis) {
    cut(reach * clip_a.w - clip_a[axis], reach * clip_b.w - clip_b[axis]);
    cut(reach * clip_a.w + clip_a[axis], reach * clip_b.w + clip_b[axis]);
  }
  if (begin > end) return std::nullopt;
  const auto place = [&](float along) {
    const glm::vec4 clip = glm::mix(clip_a, clip_b, along);
    return 0.5f + 0.5f * glm::vec2(clip) / clip.w;
  };
  return std::pair(place(begin), place(end));
}

}  // namespace heliograph::session
