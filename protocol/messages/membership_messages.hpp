#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about sessions: their list, their viewers, control of them, and what viewers show each
// other.

namespace heliograph::protocol {

struct ViewerInfo {
  std::string viewer;
  std::optional<std::string> name;
  bool control = false;
  bool you = false;

  static constexpr auto fields() {
    return std::tuple{
        field("viewer", &ViewerInfo::viewer, "The viewer's id."),
        field("name", &ViewerInfo::name, "Display name of the viewer; null: not given.").or_null(),
        field("control", &ViewerInfo::control, "Whether it has control of the session."),
        field("you", &ViewerInfo::you, "Whether it is the receiver of this message."),
    };
  }
  bool operator==(const ViewerInfo&) const = default;
};

struct SessionInfo {
  std::string name;
  std::optional<std::string> scene;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<ViewerInfo> viewers;
  ControlMode control = ControlMode::shared;
  std::uint32_t rev = 0;
  double idle_seconds = 0.0;
  std::uint32_t device = 0;
  std::optional<std::string> follows;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SessionInfo::name, "Name for session.join."),
        field("scene", &SessionInfo::scene, "The loaded scene; null: none.").or_null(),
        field("width", &SessionInfo::width, "Frame width.").unit("pixels"),
        field("height", &SessionInfo::height, "Frame height.").unit("pixels"),
        field("viewers", &SessionInfo::viewers, "The viewers in it, in order of arrival."),
        field("control", &SessionInfo::control,
              "Whether all viewers have control (shared) or one viewer (exclusive)."),
        field("rev", &SessionInfo::rev, "Revision of the session's state."),
        field("idle_seconds", &SessionInfo::idle_seconds,
              "Time since the session last had a viewer, a call or a frame to render.")
            .unit("seconds"),
        field("device", &SessionInfo::device,
              "Index of the device that renders it, among the server's devices."),
        field("follows", &SessionInfo::follows,
              "The session whose scene and settings it shows with a camera of its own; absent: it "
              "has its own."),
    };
  }
  bool operator==(const SessionInfo&) const = default;
};

struct SessionCreate {
  std::optional<std::string> name;
  std::optional<std::string> scene;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<RawJson> settings;
  std::optional<std::string> copy_of;
  std::optional<std::uint32_t> idle_timeout;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SessionCreate::name,
              "Letters, digits, dots, hyphens and underscores; absent: the server chooses.")
            .length(1, max_session_name),
        field("scene", &SessionCreate::scene,
              "A name from scene.list; the call returns when the scene is loaded.")
            .length(1, max_scene_name),
        field("width", &SessionCreate::width, "Frame width.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("height", &SessionCreate::height, "Frame height.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("settings", &SessionCreate::settings,
              "A merge patch of the settings tree (RFC 7386), applied to the server's defaults or "
              "the copied settings."),
        field("copy_of", &SessionCreate::copy_of,
              "A session from which scene, camera, clip, settings and size are copied.")
            .length(1, max_session_name),
        field(
            "idle_timeout", &SessionCreate::idle_timeout,
            "Time without viewers and calls after which the session ends; at most, and if absent, "
            "the server's.")
            .range(1, max_idle_timeout)
            .unit("seconds"),
    };
  }
  bool operator==(const SessionCreate&) const = default;
};

struct SessionChoice {
  std::string session;

  static constexpr auto fields() {
    return std::tuple{
        field("session", &SessionChoice::session, "A name from session.list.")
            .length(1, max_session_name),
    };
  }
  bool operator==(const SessionChoice&) const = default;
};

struct SessionJoined {
  std::string session;
  std::string viewer;
  std::uint32_t rev = 0;
  SessionInfo info;

  static constexpr auto fields() {
    return std::tuple{
        field("session", &SessionJoined::session, "The session that the viewer is in now."),
        field("viewer", &SessionJoined::viewer, "This viewer's id; it does not change."),
        field("rev", &SessionJoined::rev, "Revision of the session's state."),
        field("info", &SessionJoined::info, "The session."),
    };
  }
  bool operator==(const SessionJoined&) const = default;
};

struct SessionLimitsInfo {
  std::uint32_t sessions = 0;
  std::uint32_t viewers = 0;
  std::uint32_t session_viewers = 0;
  std::uint64_t pixels = 0;
  std::uint64_t pixels_used = 0;
  std::uint32_t idle_timeout = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("sessions", &SessionLimitsInfo::sessions, "Maximum number of sessions."),
        field("viewers", &SessionLimitsInfo::viewers,
              "Maximum number of viewers over all sessions."),
        field("session_viewers", &SessionLimitsInfo::session_viewers,
              "Maximum number of viewers of a session."),
        field("pixels", &SessionLimitsInfo::pixels,
              "Maximum sum of the frame sizes of all sessions."),
        field("pixels_used", &SessionLimitsInfo::pixels_used, "Current sum of the frame sizes."),
        field("idle_timeout", &SessionLimitsInfo::idle_timeout,
              "Idle time after which a session other than main is closed; 0: never.")
            .unit("seconds"),
    };
  }
  bool operator==(const SessionLimitsInfo&) const = default;
};

struct SessionList {
  std::vector<SessionInfo> sessions;
  SessionLimitsInfo limits;

  static constexpr auto fields() {
    return std::tuple{
        field("sessions", &SessionList::sessions, "All sessions, by name."),
        field("limits", &SessionList::limits, "Limits of the server."),
    };
  }
  bool operator==(const SessionList&) const = default;
};

struct SessionControl {
  std::optional<ControlMode> mode;
  std::optional<ControlAction> action;
  std::optional<std::string> viewer;

  static constexpr auto fields() {
    return std::tuple{
        field("mode", &SessionControl::mode,
              "shared: all viewers have control; exclusive: one viewer has, the one that `viewer` "
              "names or the caller."),
        field("action", &SessionControl::action,
              "In exclusive mode: take control while it is free, give it to `viewer`, or release "
              "it."),
        field("viewer", &SessionControl::viewer, "Id of the viewer that gets control.")
            .length(1, max_session_name),
    };
  }
  bool operator==(const SessionControl&) const = default;
};

struct PointerSet {
  std::optional<Vec3> position;

  static constexpr auto fields() {
    return std::tuple{
        field(
            "position", &PointerSet::position,
            "The point of the scene under the pointer, world space; absent: it has left the view.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
    };
  }
  bool operator==(const PointerSet&) const = default;
};

struct PointerChanged {
  std::string viewer;
  std::optional<std::string> name;
  std::optional<Vec3> position;

  static constexpr auto fields() {
    return std::tuple{
        field("viewer", &PointerChanged::viewer, "The viewer whose pointer it is."),
        field("name", &PointerChanged::name, "Display name of the viewer; null: not given.")
            .or_null(),
        field("position", &PointerChanged::position,
              "What it points at, world space; null: it has left the view.")
            .unit("metres")
            .or_null(),
    };
  }
  bool operator==(const PointerChanged&) const = default;
};

struct ViewerFollow {
  std::optional<std::string> viewer;

  static constexpr auto fields() {
    return std::tuple{
        field("viewer", &ViewerFollow::viewer,
              "Id of the viewer whose camera is taken over; absent: none from now on.")
            .length(1, max_session_name),
    };
  }
  bool operator==(const ViewerFollow&) const = default;
};

struct ViewerUnfollowed {
  std::string viewer;

  static constexpr auto fields() {
    return std::tuple{
        field("viewer", &ViewerUnfollowed::viewer, "The viewer that was followed."),
    };
  }
  bool operator==(const ViewerUnfollowed&) const = default;
};

struct SessionClosed {
  std::string session;
  std::string reason;

  static constexpr auto fields() {
    return std::tuple{
        field("session", &SessionClosed::session, "The session that was closed."),
        field("reason", &SessionClosed::reason, "The reason, as a sentence."),
    };
  }
  bool operator==(const SessionClosed&) const = default;
};

struct DeviceChanged {
  bool ready = false;
  std::string message;

  static constexpr auto fields() {
    return std::tuple{
        field("ready", &DeviceChanged::ready, "Whether frames can be rendered."),
        field("message", &DeviceChanged::message, "What happened, as a sentence."),
    };
  }
  bool operator==(const DeviceChanged&) const = default;
};

}  // namespace heliograph::protocol
