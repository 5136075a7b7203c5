#include "cli/render/render_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "protocol/json/json_values.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"
#include "scene/animation/pose.hpp"
#include "scene/camera/camera_choice.hpp"
#include "scene/camera/camera_path.hpp"

namespace heliograph::cli {
namespace {

constexpr std::string_view all_cameras = "all";

std::uint32_t side(double length) {
  return std::clamp(static_cast<std::uint32_t>(std::lround(length)), protocol::min_frame_size,
                    protocol::max_frame_size);
}

template <class Named>
std::vector<std::string_view> names_of(const std::vector<Named>& list) {
  std::vector<std::string_view> names;
  for (const Named& entry : list) names.push_back(entry.name);
  return names;
}

/// Around the vertical axis.
glm::mat3 rotation_of(double turns) {
  const auto angle = static_cast<float>(2.0 * std::numbers::pi * turns);
  return glm::mat3(glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.0f, 1.0f, 0.0f)));
}

/// The first of them: "front, side or 30 more".
std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  if (names.size() > most) text += " or " + std::to_string(names.size() - most) + " more";
  return text;
}

scene::Camera camera_of(const protocol::RenderView& view) {
  const auto vector = [](const std::array<float, 3>& v) { return glm::vec3(v[0], v[1], v[2]); };
  scene::Camera camera;
  camera.name = "view";
  camera.eye = vector(view.eye);
  camera.target = vector(view.target);
  camera.up = vector(view.up);
  camera.vertical_fov = view.vertical_fov;
  return camera;
}

/// A camera in each frame's direction of a turn that begins at `back`, which see the whole scene:
/// the first of them.
scene::Camera fitted(const scene::Bounds& shown, const protocol::RenderRequest& request,
                     const glm::vec3& back, const scene::Camera& lens) {
  const FrameSize size = frame_size(request);
  const std::uint32_t frames = request.turntable.value_or(1);
  std::vector<glm::vec3> directions;
  for (std::uint32_t i = 0; i < frames; ++i) {
    directions.push_back(rotation_of(static_cast<double>(i) / frames) * back);
  }
  scene::Camera camera =
      scene::fit_cameras(
          shown, directions,
          {.vertical_fov = lens.vertical_fov,
           .aspect = static_cast<float>(size.width) / static_cast<float>(size.height),
           .margin = static_cast<float>(request.margin.value_or(scene::default_margin))})
          .front();
  camera.name = lens.name;
  return camera;
}

std::vector<scene::Camera> named_cameras(const scene::Scene& scene,
                                         const protocol::RenderRequest& request) {
  if (request.path) return {camera_of(request.path->keys.front())};
  if (request.view) return {camera_of(*request.view)};
  if (request.camera == all_cameras && !scene.cameras.empty()) return scene.cameras;
  if (!request.camera.empty() && request.camera != all_cameras) {
    if (const scene::Camera* camera = scene::find_camera(scene, request.camera)) return {*camera};
    if (scene.cameras.empty()) throw std::runtime_error("--camera: the scene has no cameras");
    throw std::runtime_error("--camera: the scene has no camera " + request.camera +
                             protocol::suggestion(request.camera, names_of(scene.cameras)) + " (" +
                             listed(names_of(scene.cameras)) + ")");
  }
  if (!scene.cameras.empty()) return {scene.cameras.front()};
  return {};
}

std::vector<scene::Camera> choose_cameras(const scene::Scene& scene, const scene::Bounds& shown,
                                          const protocol::RenderRequest& request) {
  scene::Camera lens;
  if (request.orbit) {
    const auto [azimuth, elevation] = *request.orbit;
    lens.name = "orbit";
    return {fitted(shown, request, scene::orbit_direction(azimuth, elevation), lens)};
  }
  std::vector<scene::Camera> cameras = named_cameras(scene, request);
  if (cameras.empty()) {
    lens.name = "fit";
    return {fitted(shown, request, scene::default_direction(), lens)};
  }
  if (!request.fit) {
    if (!request.margin) return cameras;
    throw std::runtime_error("--margin: needs --fit or --orbit, as the scene has cameras");
  }
  for (scene::Camera& camera : cameras) {
    camera = fitted(shown, request, glm::normalize(camera.eye - camera.target), camera);
  }
  return cameras;
}

std::string length_of(const scene::Clip& clip) {
  return "the clip " + clip.name + " is " +
         protocol::number_text(std::round(1e3 * static_cast<double>(clip.duration)) / 1e3) +
         " s long";
}

/// The clip that the request names, or null if it names none.
const scene::Clip* choose_clip(const scene::Scene& scene, const protocol::RenderRequest& request) {
  if (request.clip.empty()) return nullptr;
  if (const scene::Clip* clip = scene::find_clip(scene, request.clip)) return clip;
  if (scene.clips.empty()) throw std::runtime_error("--clip: the scene has no clips");
  throw std::runtime_error("--clip: the scene has no clip " + request.clip +
                           protocol::suggestion(request.clip, names_of<scene::Clip>(scene.clips)));
}

/// The camera at a time of the clip, if the clip moves it or changes its lens.
scene::Camera posed(const scene::Scene& scene, const scene::Camera& camera, const scene::Clip* clip,
                    double seconds) {
  if (!clip || !scene::carries(scene, *clip, camera)) return camera;
  return scene::camera_at(scene, camera, clip, seconds);
}

/// The camera carried around the vertical axis through the middle of the scene.
scene::Camera turned(const scene::Scene& scene, scene::Camera camera, double turns) {
  const glm::vec3 middle = scene.bounds.empty() ? camera.target : scene.bounds.center();
  const glm::mat3 rotation = rotation_of(turns);
  camera.eye = middle + rotation * (camera.eye - middle);
  camera.target = middle + rotation * (camera.target - middle);
  camera.up = rotation * camera.up;
  return camera;
}

/// In a frame of so many: the first is at the first key, and one of an open path at the last.
scene::Camera along_path(const protocol::CameraPath& path, std::uint32_t frame,
                         std::uint32_t frames) {
  std::vector<scene::Camera> keys;
  for (const protocol::RenderView& key : path.keys) keys.push_back(camera_of(key));
  const std::uint32_t steps = path.closed ? frames : std::max(frames, 2u) - 1;
  return scene::camera_on_path(
      keys, {.smooth = path.easing == protocol::PathEasing::smooth, .closed = path.closed},
      static_cast<float>(frame) / static_cast<float>(steps));
}

}  // namespace

FrameSize frame_size(const protocol::RenderRequest& request) {
  const FrameSize usual;
  const double aspect = static_cast<double>(usual.width) / usual.height;
  if (request.width)
    return {*request.width, request.height.value_or(side(*request.width / aspect))};
  if (request.height) return {side(*request.height * aspect), *request.height};
  return usual;
}

std::vector<Shot> plan_shots(const scene::Scene& scene, const scene::Bounds& shown,
                             const protocol::RenderRequest& request) {
  const scene::Clip* const clip = choose_clip(scene, request);
  if (clip && request.time > static_cast<double>(clip->duration)) {
    throw std::runtime_error("--time: " + length_of(*clip));
  }
  std::vector<Shot> shots;
  const std::uint32_t frames = protocol::frame_count(request);
  std::size_t camera_number = 0;
  for (const scene::Camera& camera : choose_cameras(scene, shown, request)) {
    for (std::uint32_t i = 0; i < frames; ++i) {
      const double seconds = request.time + (request.turntable ? 0.0 : i / request.fps);
      scene::Camera at_time = posed(scene, camera, clip, seconds);
      if (request.turntable) at_time = turned(scene, at_time, static_cast<double>(i) / frames);
      if (request.path) at_time = along_path(*request.path, i, frames);
      at_time.name = camera.name;
      const bool cut = i == 0 || request.turntable.has_value();
      shots.push_back({.camera = at_time,
                       .seconds = seconds,
                       .frame = i,
                       .camera_number = camera_number,
                       .cut = cut});
    }
    ++camera_number;
  }
  return shots;
}

std::string note_on_clip(const scene::Scene& scene, const protocol::RenderRequest& request) {
  const scene::Clip* const clip = choose_clip(scene, request);
  if (!clip || request.turntable) return {};
  const double left = static_cast<double>(clip->duration) - request.time;
  const auto within = static_cast<std::uint32_t>(std::floor(left * request.fps + 1e-6)) + 1;
  if (protocol::frame_count(request) <= within) return {};
  return length_of(*clip) + ": frames from " + std::to_string(within) + " on repeat it";
}

}  // namespace heliograph::cli
