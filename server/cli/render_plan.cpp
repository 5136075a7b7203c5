#include "cli/render_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "protocol/json/json_values.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"
#include "scene/animation/pose.hpp"
#include "scene/camera.hpp"
#include "scene/camera_choice.hpp"

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

std::vector<scene::Camera> choose_cameras(const scene::Scene& scene, const RenderOptions& options) {
  if (options.camera == all_cameras && !scene.cameras.empty()) return scene.cameras;
  if (!options.camera.empty() && options.camera != all_cameras) {
    if (const scene::Camera* camera = scene::find_camera(scene, options.camera)) return {*camera};
    const std::string many = std::to_string(scene.cameras.size());
    const std::string what =
        scene.cameras.empty() ? "no cameras" : "no camera " + options.camera + " among its " + many;
    throw std::runtime_error("--camera: the scene has " + what +
                             protocol::suggestion(options.camera, names_of(scene.cameras)));
  }
  if (!scene.cameras.empty()) return {scene.cameras.front()};
  const FrameSize size = frame_size(options);
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  return {scene::fit_camera(scene.bounds, scene::Camera().vertical_fov, aspect)};
}

std::string length_of(const scene::Clip& clip) {
  return "the clip " + clip.name + " is " +
         protocol::number_text(std::round(1e3 * static_cast<double>(clip.duration)) / 1e3) +
         " s long";
}

/// The clip that the options name, or null if they name none.
const scene::Clip* choose_clip(const scene::Scene& scene, const RenderOptions& options) {
  if (options.clip.empty()) return nullptr;
  if (const scene::Clip* clip = scene::find_clip(scene, options.clip)) return clip;
  if (scene.clips.empty()) throw std::runtime_error("--clip: the scene has no clips");
  throw std::runtime_error("--clip: the scene has no clip " + options.clip +
                           protocol::suggestion(options.clip, names_of(scene.clips)));
}

/// The camera at a time of the clip, if the clip moves it.
scene::Camera posed(const scene::Scene& scene, const scene::Camera& camera, const scene::Clip* clip,
                    double seconds) {
  if (!clip || !scene::carries(scene, *clip, camera)) return camera;
  scene::Pose pose = scene::rest_pose(scene);
  scene::evaluate(scene, *clip, seconds, pose);
  return scene::camera_at(scene, camera, pose);
}

/// The camera carried around the vertical axis through the middle of the scene.
scene::Camera turned(const scene::Scene& scene, scene::Camera camera, double turns) {
  const glm::vec3 middle = scene.bounds.empty() ? camera.target : scene.bounds.center();
  const auto angle = static_cast<float>(2.0 * std::numbers::pi * turns);
  const glm::mat3 rotation(glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.0f, 1.0f, 0.0f)));
  camera.eye = middle + rotation * (camera.eye - middle);
  camera.target = middle + rotation * (camera.target - middle);
  camera.up = rotation * camera.up;
  return camera;
}

/// Frames of each camera.
std::uint32_t frame_count(const RenderOptions& options) {
  if (options.turntable) return *options.turntable;
  return options.timings ? 1 : options.frames.value_or(1);
}

}  // namespace

FrameSize frame_size(const RenderOptions& options) {
  const FrameSize usual;
  const double aspect = static_cast<double>(usual.width) / usual.height;
  if (options.width)
    return {*options.width, options.height.value_or(side(*options.width / aspect))};
  if (options.height) return {side(*options.height * aspect), *options.height};
  return usual;
}

std::vector<Shot> plan_shots(const scene::Scene& scene, const RenderOptions& options) {
  const scene::Clip* const clip = choose_clip(scene, options);
  if (clip && options.time > static_cast<double>(clip->duration)) {
    throw std::runtime_error("--time: " + length_of(*clip));
  }
  std::vector<Shot> shots;
  const std::uint32_t frames = frame_count(options);
  for (const scene::Camera& camera : choose_cameras(scene, options)) {
    for (std::uint32_t i = 0; i < frames; ++i) {
      const double seconds = options.time + (options.turntable ? 0.0 : i / options.fps);
      scene::Camera at_time = posed(scene, camera, clip, seconds);
      if (options.turntable) at_time = turned(scene, at_time, static_cast<double>(i) / frames);
      at_time.name = camera.name;
      const bool cut = i == 0 || options.turntable.has_value();
      shots.push_back({.camera = at_time, .seconds = seconds, .frame = i, .cut = cut});
    }
  }
  return shots;
}

std::string note_on_clip(const scene::Scene& scene, const RenderOptions& options) {
  const scene::Clip* const clip = choose_clip(scene, options);
  if (!clip || options.turntable) return {};
  const double left = static_cast<double>(clip->duration) - options.time;
  const auto within = static_cast<std::uint32_t>(std::floor(left * options.fps + 1e-6)) + 1;
  if (frame_count(options) <= within) return {};
  return length_of(*clip) + ": frames from " + std::to_string(within) + " on repeat it";
}

}  // namespace heliograph::cli
