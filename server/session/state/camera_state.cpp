#include "session/state/camera_state.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "protocol/json/json_values.hpp"
#include "protocol/json/suggestions.hpp"
#include "scene/animation/pose.hpp"
#include "scene/camera/camera.hpp"
#include "scene/camera/camera_choice.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

Result<scene::Camera> named_camera(const scene::Scene& scene, const std::string& name) {
  if (const scene::Camera* camera = scene::find_camera(scene, name)) return *camera;
  std::vector<std::string_view> names;
  for (const scene::Camera& camera : scene.cameras) names.push_back(camera.name);
  return error::not_found("name",
                          "the scene has no such camera" + protocol::suggestion(name, names));
}

/// Whether eye and target are far enough apart for floats to give a direction. In doubles, since
/// the squares of a scene camera's coordinates may exceed the range of floats.
bool has_direction(const scene::Camera& camera) {
  const glm::dvec3 eye(camera.eye);
  const glm::dvec3 target(camera.target);
  return glm::distance(eye, target) > 1e-6 * (glm::length(eye) + glm::length(target));
}

/// Whether camera.set accepts these positions, too.
bool is_in_range(const scene::Camera& camera) {
  const glm::vec3 limit(protocol::max_coordinate);
  return glm::all(glm::lessThanEqual(glm::abs(camera.eye), limit)) &&
         glm::all(glm::lessThanEqual(glm::abs(camera.target), limit));
}

glm::vec3 in_range(const glm::vec3& point) {
  return glm::clamp(point, -protocol::max_coordinate, protocol::max_coordinate);
}

/// A camera that shows all of a box, or as much of a huge one as camera.set can show, too.
scene::Camera fitting_camera(const scene::Bounds& bounds, float vertical_fov, float aspect) {
  const float fov =
      std::clamp(vertical_fov, protocol::min_field_of_view, protocol::max_field_of_view);
  scene::Camera camera = scene::fit_camera(bounds, fov, aspect);
  if (is_in_range(camera)) return camera;
  const glm::vec3 away =
      glm::vec3(glm::normalize(glm::dvec3(camera.eye) - glm::dvec3(camera.target)) *
                (1e-3 * double{protocol::max_coordinate}));
  camera.eye = in_range(camera.eye);
  camera.target = in_range(camera.target);
  if (has_direction(camera)) return camera;
  // Both were beyond the same corner of the range.
  camera.target = in_range(camera.eye - away);
  if (!has_direction(camera)) camera.eye = in_range(camera.target + away);
  return camera;
}

Result<scene::Camera> requested_camera(scene::Camera camera, const protocol::CameraSet& request) {
  if (request.eye) camera.eye = from_protocol(*request.eye);
  if (request.target) camera.target = from_protocol(*request.target);
  if (request.up) camera.up = from_protocol(*request.up);
  if (request.vertical_fov) {
    camera.vertical_fov = *request.vertical_fov;
    camera.orthographic_height = 0.0f;
  }
  if (!has_direction(camera)) {
    return error::invalid(request.target ? "target" : "eye", "eye and target coincide");
  }
  if (glm::length(camera.up) == 0.0f) return error::invalid("up", "must not be zero");
  return camera;
}

/// The member of an orbit that makes its result invalid: distance before angles.
std::string invalid_member(const protocol::CameraOrbit& request) {
  if (request.distance) return "distance";
  if (request.dolly) return "dolly";
  return request.pitch ? "pitch" : "yaw";
}

/// Limit of an orbit's elevation: straight above and below the direction of `up` is undefined.
constexpr float max_elevation = glm::radians(89.0f);

/// The eye rotated about the target; the axis of the yaw is `up`.
scene::Camera orbited(scene::Camera camera, const protocol::CameraOrbit& request) {
  const glm::vec3 up = glm::normalize(camera.up);
  const glm::vec3 offset = camera.eye - camera.target;
  const float length = glm::length(offset);
  const float height = glm::dot(offset, up);
  glm::vec3 horizontal = offset - up * height;
  float pitch = std::atan2(height, glm::length(horizontal));
  if (glm::length(horizontal) < 1e-5f * length) {
    horizontal = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    horizontal -= up * glm::dot(horizontal, up);
  }
  horizontal = glm::normalize(horizontal);
  const float yaw = glm::radians(request.yaw.value_or(0.0f));
  const glm::vec3 outward = horizontal * std::cos(yaw) + glm::cross(up, horizontal) * std::sin(yaw);
  if (request.pitch) {
    pitch = std::clamp(pitch + glm::radians(*request.pitch), -max_elevation, max_elevation);
  }
  const float distance = request.distance.value_or(length) * request.dolly.value_or(1.0f);
  camera.eye = camera.target + distance * (outward * std::cos(pitch) + up * std::sin(pitch));
  return camera;
}

}  // namespace

void CameraState::copy_from(const CameraState& other) {
  camera_ = other.camera_;
  name_ = other.name_;
  fitted_ = other.fitted_;
  ++discontinuities_;
}

void CameraState::take_over(const CameraState& other, std::optional<std::uint64_t> before) {
  // A clip may move one that has the name of the scene's, whatever its pose is here.
  const bool shows_another = !scene::same_view(camera_, other.camera_) || name_ != other.name_;
  const bool jumped = before ? *before != other.discontinuities_ : shows_another;
  if (jumped) ++discontinuities_;
  move(other.camera_, other.name_);
  fitted_ = other.fitted_;
}

void CameraState::reset(const scene::Scene& scene, float aspect) {
  ++discontinuities_;
  fitted_ = scene.cameras.empty();
  if (fitted_) {
    camera_ = fitting_camera(scene.bounds, scene::Camera().vertical_fov, aspect);
    name_.reset();
  } else {
    camera_ = scene.cameras.front();
    name_ = camera_.name;
  }
}

Result<void> CameraState::set(const protocol::CameraSet& request, const scene::Scene& scene,
                              const std::string& by) {
  scene::Camera base = camera_;
  if (request.name) {
    Result<scene::Camera> named = named_camera(scene, *request.name);
    if (!named) return named.error();
    base = *std::move(named);
  }
  const Result<scene::Camera> camera = requested_camera(std::move(base), request);
  if (!camera) return camera.error();
  if (request.seq) input_seqs_[by] = *request.seq;
  if (request.name) ++discontinuities_;
  const bool adjusted = request.eye || request.target || request.up || request.vertical_fov;
  std::optional<std::string> name = request.name ? camera->name : name_;
  move(*camera, adjusted ? std::nullopt : std::move(name));
  return {};
}

Result<void> CameraState::orbit(const protocol::CameraOrbit& request, const std::string& by) {
  const scene::Camera camera = orbited(camera_, request);
  if (!is_in_range(camera)) {
    return error::invalid(
        invalid_member(request), "moves the camera out of range",
        "eye " + protocol::range_text({-protocol::max_coordinate, protocol::max_coordinate}));
  }
  if (!has_direction(camera)) {
    return error::invalid(invalid_member(request), "eye and target coincide");
  }
  if (request.seq) input_seqs_[by] = *request.seq;
  move(camera, std::nullopt);
  return {};
}

void CameraState::fit(const scene::Bounds& bounds, float aspect) {
  ++discontinuities_;
  move(fitting_camera(bounds, camera_.vertical_fov, aspect), std::nullopt);
}

void CameraState::move(const scene::Camera& camera, std::optional<std::string> name) {
  if (!scene::same_view(camera_, camera)) ++moves_;
  camera_ = camera;
  name_ = std::move(name);
  fitted_ = false;
}

std::vector<stream::InputEcho> CameraState::inputs() const {
  std::vector<stream::InputEcho> inputs;
  for (const auto& [viewer, seq] : input_seqs_) inputs.push_back({.viewer = viewer, .seq = seq});
  return inputs;
}

bool CameraState::follows(const scene::Scene& scene, const std::string& clip) const {
  const scene::Clip* const found = name_ ? scene::find_clip(scene, clip) : nullptr;
  return found && scene::carries(scene, *found, camera_);
}

protocol::Camera CameraState::message(std::uint32_t rev, std::uint32_t scene_rev) const {
  return {.eye = to_protocol(camera_.eye),
          .target = to_protocol(camera_.target),
          .up = to_protocol(camera_.up),
          .vertical_fov = camera_.vertical_fov,
          .name = name_,
          .fitted = fitted_,
          .scene_rev = scene_rev,
          .rev = rev};
}

}  // namespace heliograph::session
