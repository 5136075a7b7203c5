#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/enum_names.hpp"
#include "protocol/json/fields.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/settings/settings.hpp"

// What images and videos to render of a scene: an entry of a manifest and of a job.

namespace heliograph::protocol {

/// A camera that is none of the scene's.
struct RenderView {
  static constexpr bool strict = true;

  std::array<float, 3> eye{};
  std::array<float, 3> target{};
  std::array<float, 3> up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 45.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("eye", &RenderView::eye, "Position of the camera, world space.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("target", &RenderView::target, "The point at the centre of the image.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("up", &RenderView::up, "The up direction of the image.")
            .range(-max_coordinate, max_coordinate)
            .or_default(),
        field("vertical_fov", &RenderView::vertical_fov, "Vertical field of view.")
            .range(min_field_of_view, max_field_of_view)
            .unit("degrees")
            .or_default(),
    };
  }
  bool operator==(const RenderView&) const = default;
};

/// smooth: through all keys without a corner, slowly at both ends; linear: at one speed from key to
/// key.
HELIOGRAPH_ENUM(PathEasing, smooth, linear)

/// A camera that moves.
struct CameraPath {
  static constexpr bool strict = true;

  std::vector<RenderView> keys;
  double seconds = 6.0;
  PathEasing easing = PathEasing::smooth;
  bool closed = false;

  static constexpr auto fields() {
    return std::tuple{
        field("keys", &CameraPath::keys,
              "Where the camera is, at equal distances of time. Between two keys the target moves "
              "straight or along a spline, and the camera turns about it.")
            .length(min_path_keys, max_path_keys),
        field("seconds", &CameraPath::seconds, "Time from the first key to the last.")
            .range(min_path_seconds, max_path_seconds)
            .unit("seconds")
            .or_default(),
        field("easing", &CameraPath::easing,
              "smooth: through all keys without a corner, slowly at both ends; linear: at one "
              "speed from key to key.")
            .or_default(),
        field("closed", &CameraPath::closed, "Whether it leads back to the first key.")
            .or_default(),
    };
  }
  bool operator==(const CameraPath&) const = default;
};

struct RenderRequest {
  static constexpr bool strict = true;

  std::string scene;
  std::string output;
  std::optional<FileFormat> format;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::string camera;
  std::optional<RenderView> view;
  std::optional<std::array<float, 2>> orbit;
  bool fit = false;
  std::optional<double> margin;
  std::optional<std::uint32_t> turntable;
  std::optional<CameraPath> path;
  std::string clip;
  double time = 0.0;
  double fps = 30.0;
  std::optional<std::uint32_t> frames;
  std::optional<std::uint32_t> samples;
  std::optional<double> quality;
  std::optional<double> time_limit;
  std::optional<ReferenceScope> reference;
  std::string preset;
  std::optional<RawJson> settings;
  std::string buffer = "output";
  std::string variant;
  std::optional<EditDocument> edits;
  std::string environment;
  std::string background = "sky";

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &RenderRequest::scene, "The scene: a file, or in a job a name.")
            .length(1, max_path),
        field("output", &RenderRequest::output,
              "Name of the file; {scene}, {camera} and {frame:04} stand for what is in the image.")
            .length(0, max_path)
            .or_default(),
        field("format", &RenderRequest::format, "Format; absent: by the extension of the name."),
        field("width", &RenderRequest::width, "Frame width; one side gives the other at 16:9.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("height", &RenderRequest::height, "Frame height.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("camera", &RenderRequest::camera,
              "Camera of the scene by its name or its number from 1 on, or all; empty: the first.")
            .length(0, max_node_name)
            .or_default(),
        field("view", &RenderRequest::view, "Another camera than those of the scene."),
        field("orbit", &RenderRequest::orbit,
              "Another camera, which sees the whole scene: azimuth, 0 in front and 90 on the "
              "right, and elevation, 90 above.")
            .range(-360, 360)
            .unit("degrees"),
        field("fit", &RenderRequest::fit,
              "Keeps the direction of the cameras and moves them so that they see the whole scene.")
            .or_default(),
        field("margin", &RenderRequest::margin,
              "Free part of the image on each side of a scene that is fitted into it.")
            .range(0, max_margin),
        field("turntable", &RenderRequest::turntable,
              "Frames of one turn of the camera around the scene.")
            .range(1, max_rendered_frames),
        field("path", &RenderRequest::path,
              "Another camera, which moves; frames at the rate of fps, while the clip, if there is "
              "one, plays."),
        field("clip", &RenderRequest::clip, "Animation clip; empty: the default pose.")
            .length(0, max_node_name)
            .or_default(),
        field("time", &RenderRequest::time, "Time in the clip of the first frame.")
            .range(0, max_clip_time)
            .unit("seconds")
            .or_default(),
        field("fps", &RenderRequest::fps, "Frames per second of clips and videos.")
            .range(min_clip_rate, max_clip_rate)
            .or_default(),
        field("frames", &RenderRequest::frames, "Frames of the clip; absent: one.")
            .range(1, max_rendered_frames),
        field("samples", &RenderRequest::samples,
              "Samples per pixel; absent: accumulation.max_samples.")
            .range(1, max_samples_per_pixel),
        field("quality", &RenderRequest::quality,
              "Ends an image when its expected structural similarity to the converged one is this.")
            .range(min_similarity, max_similarity),
        field("time_limit", &RenderRequest::time_limit, "Ends an image after so long.")
            .range(min_time_limit, max_time_limit)
            .unit("seconds"),
        field("reference", &RenderRequest::reference,
              "Path traces these light paths; absent: the hybrid renderer."),
        field("preset", &RenderRequest::preset, "Preset of the denoiser; empty: none.")
            .length(0, max_session_name)
            .or_default(),
        field("settings", &RenderRequest::settings,
              "A merge patch of the settings, on top of the preset."),
        field("buffer", &RenderRequest::buffer, "Buffer to write.")
            .length(1, max_session_name)
            .or_default(),
        field("edits", &RenderRequest::edits,
              "Changes of the scene: a document that edits.get returned."),
        field("variant", &RenderRequest::variant, "Material variant; empty: the file's default.")
            .length(0, max_node_name)
            .or_default(),
        field("environment", &RenderRequest::environment,
              "Image that lights the scene; empty: the one beside the scene.")
            .length(0, max_path)
            .or_default(),
        field("background", &RenderRequest::background,
              "sky, blurred, transparent (PNG and WebP), or a colour such as #ffffff.")
            .length(1, max_session_name)
            .or_default(),
    };
  }
  bool operator==(const RenderRequest&) const = default;
};

/// Images of each camera.
inline std::uint32_t frame_count(const RenderRequest& request) {
  if (request.turntable) return *request.turntable;
  if (!request.path) return request.frames.value_or(1);
  const long frames = std::lround(request.path->seconds * request.fps);
  return static_cast<std::uint32_t>(std::clamp(frames, 1l, long{max_rendered_frames}));
}

}  // namespace heliograph::protocol
