#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "session/session_host.hpp"

namespace heliograph::session {

/// How an image of a session differs from what its viewers see.
struct SnapshotView {
  std::optional<std::uint32_t> width;  ///< one side gives the other by the session's aspect
  std::optional<std::uint32_t> height;
  std::optional<std::string> camera;  ///< name or number, as in camera.set
  bool fit = false;                   ///< shows the whole scene, as camera.fit does
  std::optional<bool> background;     ///< instead of environment.visible
  bool transparent = false;           ///< a PNG file without background

  bool as_shown() const {
    return !width && !height && !camera && !fit && !background && !transparent;
  }
};

/// Captures an image of a session. One that differs is rendered in a session of its own, a copy
/// that ends with the capture: viewers do not notice, and the limits on sessions and pixels hold.
protocol::Result<void> request_snapshot(SessionHost& host, const std::shared_ptr<Session>& shown,
                                        const SnapshotView& view, CaptureRequest capture);

}  // namespace heliograph::session
