#pragma once

#include <memory>

#include "session/session.hpp"

namespace heliograph::session {

/// Captures a session's image as a PNG file whose background is transparent. The session shows
/// other images meanwhile and keeps its settings changed: it is a copy that ends afterwards.
protocol::Result<void> request_transparent_capture(const std::shared_ptr<Session>& copy,
                                                   CaptureRequest capture);

}  // namespace heliograph::session
