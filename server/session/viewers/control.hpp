#pragma once

#include <functional>
#include <string>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::session {

/// Whether a caller may change a session: in shared mode every caller, in exclusive mode the viewer
/// that holds control. Callers without a stream may as long as no viewer holds it; they may always
/// give control to a viewer or change the mode while it is free. Pure logic.
class Control {
 public:
  /// Whether the viewer is in the session and may have control.
  using IsPresent = std::function<bool(const std::string& viewer)>;

  protocol::ControlMode mode() const { return mode_; }
  /// Whether control is exclusive and no viewer holds it.
  bool is_free() const { return mode_ == protocol::ControlMode::exclusive && holder_.empty(); }
  /// `viewer` is empty for callers without a stream.
  bool may_change(const std::string& viewer) const;

  /// Applies the request of `by`; on an error nothing changes.
  protocol::Result<void> apply(const protocol::SessionControl& request, const std::string& by,
                               const IsPresent& is_present);
  /// A viewer that leaves releases control: any other may take it.
  void on_viewer_left(const std::string& viewer);

 private:
  protocol::Result<void> set_mode(const protocol::SessionControl& request, const std::string& by,
                                  const IsPresent& is_present);
  protocol::Result<void> act(protocol::ControlAction action,
                             const protocol::SessionControl& request, const std::string& by,
                             const IsPresent& is_present);
  protocol::Result<void> hand_to(const std::string& viewer, const IsPresent& is_present);

  protocol::ControlMode mode_ = protocol::ControlMode::shared;
  std::string holder_;  // in exclusive mode; empty: no viewer
};

}  // namespace heliograph::session
