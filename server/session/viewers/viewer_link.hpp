#pragma once

#include <string>
#include <string_view>

namespace heliograph::session {

/// The connection to one viewer, provided by the transport. Calls come from any thread and with
/// locks held: they return at once and do not call back.
class ViewerLink {
 public:
  virtual ~ViewerLink() = default;
  /// ViewerSet::take has a frame for this viewer.
  virtual void frame_ready() = 0;
  /// Sends a text message. It replaces queued messages with the same `key`, unless the key is
  /// empty: only the newest position of a camera matters.
  virtual void send(std::string text, std::string_view key) = 0;
  /// Ends the connection once everything is sent, since the viewer's session has ended. `reason` is
  /// readable text.
  virtual void disconnect(std::string reason) = 0;
};

}  // namespace heliograph::session
