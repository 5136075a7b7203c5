#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/animation_messages.hpp"
#include "protocol/messages/kinds.hpp"

// Messages about the session: hello, camera, settings, presets.

namespace heliograph::protocol {

/// x, y, z in metres or as a direction; world space, +Y up, right-handed.
using Vec3 = std::array<float, 3>;

inline constexpr std::string_view protocol_name = "heliograph.v1";

/// Who may measure and annotate.
HELIOGRAPH_ENUM(Annotators, control, everyone)

/// Parameters of methods without parameters.
struct Empty {
  static constexpr auto fields() { return std::tuple{}; }
  bool operator==(const Empty&) const = default;
};

struct Hello {
  std::optional<std::string> client;
  std::vector<std::string> codecs{"jpeg"};
  std::optional<std::string> session;
  std::optional<std::string> instance;
  std::optional<std::string> name;

  static constexpr auto fields() {
    return std::tuple{
        field("client", &Hello::client, "Name and version of the client, for the log.")
            .length(0, 200),
        field("codecs", &Hello::codecs, "Frame codecs that the client can decode, preferred first.")
            .length(1, 16)
            .or_default(),
        field("session", &Hello::session,
              "The session to join; absent: the one in /ws?session=NAME, or main.")
            .length(1, max_session_name),
        field("instance", &Hello::instance,
              "On reconnect: the `instance` of the server process that `session` was on. If it "
              "differs, the server picks a session that other viewers do not use; see "
              "`restore_state`.")
            .length(1, max_session_name),
        field("name", &Hello::name, "Display name, shown to the other viewers of the session.")
            .length(1, max_session_name),
    };
  }
  bool operator==(const Hello&) const = default;
};

struct DeviceInfo {
  std::string name;
  std::string driver;
  DeviceType type = DeviceType::other;
  std::uint32_t index = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &DeviceInfo::name, "Name of the Vulkan device."),
        field("driver", &DeviceInfo::driver, "Name and version of its driver."),
        field("type", &DeviceInfo::type, "Kind of device."),
        field("index", &DeviceInfo::index,
              "Its index among the server's devices, from 0 on; the label `device` of metrics."),
    };
  }
  bool operator==(const DeviceInfo&) const = default;
};

struct ServerLimits {
  std::uint32_t max_width = 0;
  std::uint32_t max_height = 0;
  std::uint32_t max_message_bytes = 0;
  std::uint32_t ack_window = 0;
  std::uint32_t max_batch = 0;
  std::uint32_t max_pending = 0;
  std::uint64_t max_upload_bytes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("max_width", &ServerLimits::max_width, "Maximum frame width.").unit("pixels"),
        field("max_height", &ServerLimits::max_height, "Maximum frame height.").unit("pixels"),
        field("max_message_bytes", &ServerLimits::max_message_bytes,
              "Maximum size of a message to the server.")
            .unit("bytes"),
        field("ack_window", &ServerLimits::ack_window,
              "Frames that the server sends ahead of the newest stream.ack; up to 8 where the "
              "round trip is long."),
        field("max_batch", &ServerLimits::max_batch, "Maximum number of calls of a batch."),
        field("max_pending", &ServerLimits::max_pending,
              "Maximum number of pending captures of a session; also of pending steps, and of "
              "pending picks and inspections."),
        field("max_upload_bytes", &ServerLimits::max_upload_bytes,
              "Maximum size of an uploaded scene; 0: uploads are not allowed.")
            .unit("bytes"),
    };
  }
  bool operator==(const ServerLimits&) const = default;
};

struct HelloResult {
  std::string protocol{protocol_name};
  std::string version;
  DeviceInfo device;
  TracerKind tracer = TracerKind::software;
  std::string session;
  std::string viewer;
  ViewerRole role = ViewerRole::control;
  std::vector<std::string> codecs;
  std::optional<std::string> codec_reason;
  ServerLimits limits;
  Annotators annotators = Annotators::control;
  std::uint32_t rev = 0;
  std::string instance;
  std::optional<bool> restore_state;

  static constexpr auto fields() {
    return std::tuple{
        field("protocol", &HelloResult::protocol, "Name and version of the protocol."),
        field("version", &HelloResult::version, "Version of the server."),
        field("device", &HelloResult::device, "The device that renders the session."),
        field("tracer", &HelloResult::tracer, "The ray tracer in use."),
        field("session", &HelloResult::session, "The session that the viewer is in."),
        field("viewer", &HelloResult::viewer,
              "This viewer's id: `by` in notifications to other viewers."),
        field("role", &HelloResult::role,
              "What the client's token allows: control or view only; session.info tells which "
              "viewers have control."),
        field("codecs", &HelloResult::codecs, "Codecs of the frames that follow, preferred first."),
        field("codec_reason", &HelloResult::codec_reason,
              "Why the client's preferred codec is not used; null if it is.")
            .or_null(),
        field("limits", &HelloResult::limits, "Limits of the server."),
        field("annotators", &HelloResult::annotators,
              "Who may measure and annotate: viewers that have control, or everyone, also with a "
              "token that allows viewing only."),
        field("rev", &HelloResult::rev, "Revision of the session's state."),
        field("instance", &HelloResult::instance,
              "Identifies this run of the server. If it differs after a reconnect, the session "
              "state is lost and the client sends its requests again."),
        field("restore_state", &HelloResult::restore_state,
              "After a reconnect to another run of the server: true: the client restores the "
              "session's state; false: another viewer of that session does; null: no session was "
              "available, or this is no reconnect.")
            .or_null(),
    };
  }
  bool operator==(const HelloResult&) const = default;
};

struct Camera {
  Vec3 eye{};
  Vec3 target{};
  Vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 45.0f;
  std::optional<std::string> name;
  bool fitted = false;
  std::uint32_t scene_rev = 0;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("eye", &Camera::eye, "Position of the camera, world space.").unit("metres"),
        field("target", &Camera::target, "The point at the centre of the image.").unit("metres"),
        field("up", &Camera::up, "The up direction of the image."),
        field("vertical_fov", &Camera::vertical_fov, "Vertical field of view.").unit("degrees"),
        field("name", &Camera::name, "Name of the scene camera; null after it was moved.")
            .or_null(),
        field("fitted", &Camera::fitted,
              "Whether the server has placed it to show the whole scene, and no viewer has moved "
              "it since."),
        field("scene_rev", &Camera::scene_rev,
              "Revision from which on its scene is shown; for camera.set and camera.orbit."),
        field("rev", &Camera::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const Camera&) const = default;
};

struct CameraSet {
  std::optional<Vec3> eye;
  std::optional<Vec3> target;
  std::optional<Vec3> up;
  std::optional<float> vertical_fov;
  std::optional<float> focal_length;
  std::optional<std::string> name;
  std::optional<std::uint32_t> seq;
  std::optional<std::uint32_t> scene_rev;

  static constexpr auto fields() {
    return std::tuple{
        field("eye", &CameraSet::eye, "Position of the camera, world space.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("target", &CameraSet::target, "The point at the centre of the image.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("up", &CameraSet::up, "The up direction of the image.")
            .range(-max_coordinate, max_coordinate),
        field("vertical_fov", &CameraSet::vertical_fov, "Vertical field of view.")
            .range(min_field_of_view, max_field_of_view)
            .unit("degrees"),
        field("focal_length", &CameraSet::focal_length,
              "Gives the field of view of a lens of this focal length before a sensor of the "
              "setting lens.sensor_height; instead of vertical_fov.")
            .range(0.01, 1e5)
            .unit("mm"),
        field("name", &CameraSet::name,
              "A scene camera to start from, by its name or its number from 1 on; the other "
              "members are applied on top.")
            .length(1, max_node_name),
        field("seq", &CameraSet::seq,
              "The client's sequence number; frames that show this camera echo it as "
              "input_seq_echo."),
        field("scene_rev", &CameraSet::scene_rev,
              "That of the camera from which the movement began: fails where another scene is "
              "shown by now. Absent: moves the camera of whichever scene is shown."),
    };
  }
  bool operator==(const CameraSet&) const = default;
};

struct CameraChanged {
  Camera camera;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("camera", &CameraChanged::camera, "The camera after the change."),
        field("by", &CameraChanged::by, "The viewer that moved it; empty: the server."),
    };
  }
  bool operator==(const CameraChanged&) const = default;
};

struct SettingsState {
  std::uint32_t rev = 0;
  RawJson settings;

  static constexpr auto fields() {
    return std::tuple{
        field("rev", &SettingsState::rev, "Revision of the session's state."),
        field("settings", &SettingsState::settings, "The whole tree of settings."),
    };
  }
  bool operator==(const SettingsState&) const = default;
};

struct SettingsPatch {
  RawJson patch;

  static constexpr auto fields() {
    return std::tuple{
        field("patch", &SettingsPatch::patch,
              "A merge patch of the settings tree (RFC 7386): null resets to the default."),
    };
  }
  bool operator==(const SettingsPatch&) const = default;
};

struct SettingsApplied {
  std::uint32_t rev = 0;
  RawJson applied;

  static constexpr auto fields() {
    return std::tuple{
        field("rev", &SettingsApplied::rev, "Revision of the session's state."),
        field("applied", &SettingsApplied::applied,
              "The patch as applied: each null is replaced by the default value."),
    };
  }
  bool operator==(const SettingsApplied&) const = default;
};

struct PresetInfo {
  std::string name;
  std::string description;
  RawJson settings;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &PresetInfo::name, "Name for settings.preset."),
        field("description", &PresetInfo::description, "Description of the preset."),
        field("settings", &PresetInfo::settings,
              "The patch of all settings of the denoiser that settings.preset applies."),
    };
  }
  bool operator==(const PresetInfo&) const = default;
};

struct PresetList {
  std::vector<PresetInfo> presets;

  static constexpr auto fields() {
    return std::tuple{
        field("presets", &PresetList::presets,
              "The presets: the paper's steps in order, then best."),
    };
  }
  bool operator==(const PresetList&) const = default;
};

struct PresetChoice {
  std::string name;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &PresetChoice::name, "A name from settings.presets.")
            .length(1, max_session_name),
    };
  }
  bool operator==(const PresetChoice&) const = default;
};

struct SettingsChanged {
  std::uint32_t rev = 0;
  RawJson patch;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("rev", &SettingsChanged::rev, "Revision of the session's state."),
        field("patch", &SettingsChanged::patch, "The settings that changed."),
        field("by", &SettingsChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const SettingsChanged&) const = default;
};

}  // namespace heliograph::protocol
