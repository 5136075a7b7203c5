#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/messages/animation_messages.hpp"
#include "protocol/messages/kinds.hpp"

// Messages about the session: greeting, camera, settings.

namespace heliograph::protocol {

/// x, y, z in metres or as a direction; world space, +Y up, right-handed.
using Vec3 = std::array<float, 3>;

inline constexpr std::string_view protocol_name = "heliograph.v1";

/// Parameters of methods that take none.
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
        field("codecs", &Hello::codecs, "Picture codecs the client can decode, best first.")
            .length(1, 16)
            .or_default(),
        field("session", &Hello::session,
              "The session to watch; left out: the one that /ws?session=NAME named, or main.")
            .length(1, 64),
        field("instance", &Hello::instance,
              "Of who comes back: the run of the server that `session` was on. Where it is another "
              "one, a place that disturbs nobody is found; `bring` tells of it.")
            .length(1, 64),
        field("name", &Hello::name, "What the person is called, for the others in the session.")
            .length(1, 64),
    };
  }
  bool operator==(const Hello&) const = default;
};

struct DeviceInfo {
  std::string name;
  std::string driver;
  DeviceType type = DeviceType::other;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &DeviceInfo::name, "Name of the Vulkan device."),
        field("driver", &DeviceInfo::driver, "Name and version of its driver."),
        field("type", &DeviceInfo::type, "Kind of device."),
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
  std::uint32_t max_waiting = 0;
  std::uint64_t max_upload_bytes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("max_width", &ServerLimits::max_width, "Widest picture.").unit("pixels"),
        field("max_height", &ServerLimits::max_height, "Highest picture.").unit("pixels"),
        field("max_message_bytes", &ServerLimits::max_message_bytes,
              "Longest message the server reads.")
            .unit("bytes"),
        field("ack_window", &ServerLimits::ack_window,
              "Frames the server sends ahead of the newest stream.ack; on a long way more, but no "
              "more than 8."),
        field("max_batch", &ServerLimits::max_batch, "Most calls of a batch."),
        field(
            "max_waiting", &ServerLimits::max_waiting,
            "Most captures of a session that wait for their picture; as many steps may wait beside "
            "them, and as many questions about the picture."),
        field("max_upload_bytes", &ServerLimits::max_upload_bytes,
              "Largest scene that the client may send; 0: it may send none.")
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
  std::uint32_t rev = 0;
  std::string instance;
  std::optional<bool> bring;

  static constexpr auto fields() {
    return std::tuple{
        field("protocol", &HelloResult::protocol, "Protocol and its version."),
        field("version", &HelloResult::version, "Version of the server."),
        field("device", &HelloResult::device, "Where pictures are rendered."),
        field("tracer", &HelloResult::tracer, "What traces the rays."),
        field("session", &HelloResult::session, "The session that is watched."),
        field("viewer", &HelloResult::viewer,
              "This viewer's id: the `by` of notifications to the others."),
        field("role", &HelloResult::role,
              "Whether this client's token lets it steer or only watch; session.info tells who "
              "has control."),
        field("codecs", &HelloResult::codecs, "Codecs of the frames that will come, best first."),
        field("codec_reason", &HelloResult::codec_reason,
              "Why the client's best codec is not used; null if it is.")
            .or_null(),
        field("limits", &HelloResult::limits, "What the server refuses to exceed."),
        field("rev", &HelloResult::rev, "Revision of the session's state."),
        field("instance", &HelloResult::instance,
              "Differs with every run of a server: where it is another, the session starts anew "
              "and a client that comes back says again what it wants."),
        field("bring", &HelloResult::bring,
              "To who comes back from another run: true, to bring the session's state into this "
              "one; false, that somebody who was there too does; null, that no place was found.")
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
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("eye", &Camera::eye, "Where the camera is, world space.").unit("metres"),
        field("target", &Camera::target, "The point in the middle of the picture.").unit("metres"),
        field("up", &Camera::up, "The direction that points up in the picture."),
        field("vertical_fov", &Camera::vertical_fov, "Field of view, top to bottom.")
            .unit("degrees"),
        field("name", &Camera::name, "The scene camera this is, null once it was moved.").or_null(),
        field("rev", &Camera::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const Camera&) const = default;
};

/// How far from the origin, along each axis, the camera and its target may be; metres.
inline constexpr float camera_reach = 1e9f;

struct CameraSet {
  std::optional<Vec3> eye;
  std::optional<Vec3> target;
  std::optional<Vec3> up;
  std::optional<float> vertical_fov;
  std::optional<std::string> name;
  std::optional<std::uint32_t> seq;

  static constexpr auto fields() {
    return std::tuple{
        field("eye", &CameraSet::eye, "Where the camera is, world space.")
            .range(-camera_reach, camera_reach)
            .unit("metres"),
        field("target", &CameraSet::target, "The point in the middle of the picture.")
            .range(-camera_reach, camera_reach)
            .unit("metres"),
        field("up", &CameraSet::up, "The direction that points up in the picture.")
            .range(-1e9, 1e9),
        field("vertical_fov", &CameraSet::vertical_fov, "Field of view, top to bottom.")
            .range(1, 170)
            .unit("degrees"),
        field("name", &CameraSet::name,
              "A scene camera to begin from; the other members are applied on top.")
            .length(1, 256),
        field("seq", &CameraSet::seq,
              "The client's own count; frames that show this camera echo it as input_seq_echo."),
    };
  }
  bool operator==(const CameraSet&) const = default;
};

struct CameraChanged {
  Camera camera;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("camera", &CameraChanged::camera, "The camera now."),
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
              "Part of the settings tree (RFC 7386): null resets to the default."),
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
              "The patch as applied: each null replaced by the value it led to."),
    };
  }
  bool operator==(const SettingsApplied&) const = default;
};

struct PresetInfo {
  std::string name;
  std::string description;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &PresetInfo::name, "Name for settings.preset."),
        field("description", &PresetInfo::description, "What it chooses, in a sentence."),
    };
  }
  bool operator==(const PresetInfo&) const = default;
};

struct PresetList {
  std::vector<PresetInfo> presets;

  static constexpr auto fields() {
    return std::tuple{
        field("presets", &PresetList::presets, "The presets, each on top of the last, then best."),
    };
  }
  bool operator==(const PresetList&) const = default;
};

struct PresetChoice {
  std::string name;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &PresetChoice::name, "A name that settings.presets gave.").length(1, 64),
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
