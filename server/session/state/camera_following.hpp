#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "session/state/camera_state.hpp"

namespace heliograph::session {

struct SessionCore;

/// A session that takes over the camera of another one.
struct CameraFollower {
  std::weak_ptr<SessionCore> session;
  std::uint64_t link = 0;  // the number of its CameraLink
};

/// Through which a session takes over the camera of another one.
struct CameraLink {
  /// Grows whenever a link begins or ends, so that what an ended one still brings is known.
  std::uint64_t number = 0;
  /// Of the other session, when it had the camera that was taken over last.
  std::uint64_t version = 0;
  /// How often that camera had jumped; null: none was taken over yet.
  std::optional<std::uint64_t> discontinuities = std::nullopt;
};

/// The camera of a session at one of its versions, on its way to those that take it over.
struct LedCamera {
  CameraState camera;
  std::uint64_t version = 0;
  std::uint64_t scene_loads = 0;  // see SessionCore
  std::vector<CameraFollower> followers;
};

}  // namespace heliograph::session
