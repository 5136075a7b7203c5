#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/messages/kinds.hpp"

// Messages about sessions as rooms: which there are, who is in them, who may change them.

namespace heliograph::protocol {

struct ViewerInfo {
  std::string viewer;
  std::optional<std::string> name;
  bool control = false;
  bool you = false;

  static constexpr auto fields() {
    return std::tuple{
        field("viewer", &ViewerInfo::viewer, "The viewer's id."),
        field("name", &ViewerInfo::name, "What the person is called; null: nobody said.").or_null(),
        field("control", &ViewerInfo::control, "Whether it may change what all see."),
        field("you", &ViewerInfo::you, "Whether it is the one that is told this."),
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
  ControlMode control = ControlMode::everyone;
  std::uint32_t rev = 0;
  double idle_seconds = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SessionInfo::name, "Name for session.join."),
        field("scene", &SessionInfo::scene, "The scene that is shown, null before the first.")
            .or_null(),
        field("width", &SessionInfo::width, "Picture width.").unit("pixels"),
        field("height", &SessionInfo::height, "Picture height.").unit("pixels"),
        field("viewers", &SessionInfo::viewers, "Who is in it, in order of arrival."),
        field("control", &SessionInfo::control, "Whether all viewers may change it or only one."),
        field("rev", &SessionInfo::rev, "Revision of the session's state."),
        field("idle_seconds", &SessionInfo::idle_seconds,
              "Time since it last had a viewer, a call or a picture to make.")
            .unit("seconds"),
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

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SessionCreate::name,
              "Letters, digits, dots, hyphens and underscores; left out: the server chooses.")
            .length(1, 64),
        field("scene", &SessionCreate::scene,
              "A name that scene.list gave; it is loaded before the answer comes.")
            .length(1, 512),
        field("width", &SessionCreate::width, "Picture width.").range(16, 16384).unit("pixels"),
        field("height", &SessionCreate::height, "Picture height.").range(16, 16384).unit("pixels"),
        field("settings", &SessionCreate::settings,
              "Part of the settings tree (RFC 7386), on top of the server's own or the copied."),
        field("copy_of", &SessionCreate::copy_of,
              "A session whose scene, camera, clip, settings and size it starts with.")
            .length(1, 64),
    };
  }
  bool operator==(const SessionCreate&) const = default;
};

struct SessionChoice {
  std::string session;

  static constexpr auto fields() {
    return std::tuple{
        field("session", &SessionChoice::session, "A name that session.list gave.").length(1, 64),
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
        field("session", &SessionJoined::session, "The session that is watched now."),
        field("viewer", &SessionJoined::viewer, "This viewer's id, the same as before."),
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
        field("sessions", &SessionLimitsInfo::sessions, "Most sessions."),
        field("viewers", &SessionLimitsInfo::viewers, "Most viewers of all sessions together."),
        field("session_viewers", &SessionLimitsInfo::session_viewers, "Most viewers of a session."),
        field("pixels", &SessionLimitsInfo::pixels,
              "Most pixels of the pictures of all sessions together."),
        field("pixels_used", &SessionLimitsInfo::pixels_used, "How many of them are taken."),
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
        field("limits", &SessionList::limits, "What the server refuses to exceed."),
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
              "Whether everyone has control or one viewer: the one that `viewer` names, else the "
              "caller."),
        field("action", &SessionControl::action,
              "Where one has control: take it while nobody has it, give it to `viewer`, or release "
              "it for anybody to take."),
        field("viewer", &SessionControl::viewer, "The id of who is to have control.").length(1, 64),
    };
  }
  bool operator==(const SessionControl&) const = default;
};

struct SessionClosed {
  std::string session;
  std::string reason;

  static constexpr auto fields() {
    return std::tuple{
        field("session", &SessionClosed::session, "The session that has ended."),
        field("reason", &SessionClosed::reason, "Why, in a sentence."),
    };
  }
  bool operator==(const SessionClosed&) const = default;
};

struct DeviceChanged {
  bool ready = false;
  std::string message;

  static constexpr auto fields() {
    return std::tuple{
        field("ready", &DeviceChanged::ready, "Whether pictures are made."),
        field("message", &DeviceChanged::message, "What happened, in a sentence."),
    };
  }
  bool operator==(const DeviceChanged&) const = default;
};

}  // namespace heliograph::protocol
