#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "protocol/json/json_values.hpp"
#include "protocol/json/jsonrpc.hpp"
#include "protocol/json/suggestions.hpp"
#include "scene/camera.hpp"
#include "session/library/scene_description.hpp"
#include "session/state/session.hpp"

// The camera of a session.

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

Result<scene::Camera> named_camera(const scene::Scene& scene, const std::string& name) {
  std::vector<std::string_view> names;
  for (const scene::Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  return error::not_found("name",
                          "the scene has no such camera" + protocol::suggestion(name, names));
}

/// Whether eye and target are far enough apart for floats to tell a direction. In doubles, since
/// squares of what a scene's own camera may hold are too much for floats.
bool has_direction(const scene::Camera& camera) {
  const glm::dvec3 eye(camera.eye);
  const glm::dvec3 target(camera.target);
  return glm::distance(eye, target) > 1e-6 * (glm::length(eye) + glm::length(target));
}

/// Whether camera.set would take these places, too.
bool is_within_reach(const scene::Camera& camera) {
  const glm::vec3 reach(protocol::max_coordinate);
  return glm::all(glm::lessThanEqual(glm::abs(camera.eye), reach)) &&
         glm::all(glm::lessThanEqual(glm::abs(camera.target), reach));
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

/// What of an orbit leads where the camera cannot be: what changes the distance, before what turns.
std::string misleading_member(const protocol::CameraOrbit& request) {
  if (request.distance) return "distance";
  if (request.dolly) return "dolly";
  return request.pitch ? "pitch" : "yaw";
}

/// How near to straight above or below an orbit comes.
constexpr float steepest = glm::radians(89.0f);

/// The eye carried about the target; `up` is the axis.
scene::Camera orbited(scene::Camera camera, const protocol::CameraOrbit& request) {
  const glm::vec3 up = glm::normalize(camera.up);
  const glm::vec3 arm = camera.eye - camera.target;
  const float length = glm::length(arm);
  const float height = glm::dot(arm, up);
  glm::vec3 level = arm - up * height;
  float pitch = std::atan2(height, glm::length(level));
  if (glm::length(level) < 1e-5f * length) {
    level = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    level -= up * glm::dot(level, up);
  }
  level = glm::normalize(level);
  const float yaw = glm::radians(request.yaw.value_or(0.0f));
  const glm::vec3 outward = level * std::cos(yaw) + glm::cross(up, level) * std::sin(yaw);
  if (request.pitch) {
    pitch = std::clamp(pitch + glm::radians(*request.pitch), -steepest, steepest);
  }
  const float distance = request.distance.value_or(length) * request.dolly.value_or(1.0f);
  camera.eye = camera.target + distance * (outward * std::cos(pitch) + up * std::sin(pitch));
  return camera;
}

}  // namespace

Result<protocol::Camera> Session::camera() const {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  return camera_message();
}

Result<protocol::Camera> Session::set_camera(const protocol::CameraSet& request,
                                             const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  scene::Camera base = state_.camera;
  if (request.name) {
    Result<scene::Camera> named = named_camera(*scene_, *request.name);
    if (!named) return named.error();
    base = *std::move(named);
  }
  const Result<scene::Camera> camera = requested_camera(std::move(base), request);
  if (!camera) return camera.error();
  if (request.seq) input_seqs_[by] = *request.seq;

  const bool adjusted = request.eye || request.target || request.up || request.vertical_fov;
  if (request.name) ++state_.cuts;
  std::optional<std::string> name = request.name ? request.name : camera_name_;
  return moved_camera(*camera, adjusted ? std::nullopt : std::move(name), by);
}

Result<protocol::Camera> Session::orbit_camera(const protocol::CameraOrbit& request,
                                               const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  const scene::Camera camera = orbited(state_.camera, request);
  if (!is_within_reach(camera)) {
    return error::invalid(
        misleading_member(request), "moves the camera out of range",
        "eye " + protocol::range_text({-protocol::max_coordinate, protocol::max_coordinate}));
  }
  if (!has_direction(camera)) {
    return error::invalid(misleading_member(request), "eye and target coincide");
  }
  if (request.seq) input_seqs_[by] = *request.seq;
  return moved_camera(camera, std::nullopt, by);
}

Result<protocol::Camera> Session::fit_camera(const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  const scene::Camera camera =
      scene::fit_camera(scene_->bounds, state_.camera.vertical_fov, aspect());
  ++state_.cuts;
  return moved_camera(camera, std::nullopt, by);
}

protocol::Camera Session::moved_camera(const scene::Camera& camera, std::optional<std::string> name,
                                       const std::string& by) {
  state_.camera = camera;
  camera_name_ = std::move(name);
  changed();
  const protocol::CameraChanged message{.camera = camera_message(), .by = by};
  viewers_.send_others(
      by, protocol::make_notification<protocol::notifications::camera_changed>(message),
      "camera.changed");
  return message.camera;
}

protocol::Camera Session::camera_message() const {
  return {.eye = to_protocol(state_.camera.eye),
          .target = to_protocol(state_.camera.target),
          .up = to_protocol(state_.camera.up),
          .vertical_fov = state_.camera.vertical_fov,
          .name = camera_name_,
          .rev = state_.rev};
}

}  // namespace heliograph::session
