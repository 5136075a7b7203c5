#pragma once

#include <functional>
#include <string>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::session {

/// Who may change a session: everyone in it, or one viewer. Callers without a stream, who are in no
/// session, may unless a viewer has control; who they may hand it to or open it for is not limited,
/// so that a program can always settle matters. Pure logic.
class Control {
 public:
  /// Whether somebody of this id is in the session and may have control.
  using IsPresent = std::function<bool(const std::string& viewer)>;

  protocol::ControlMode mode() const { return mode_; }
  /// Whether one viewer is to have control and none has.
  bool is_free() const { return mode_ == protocol::ControlMode::exclusive && holder_.empty(); }
  /// `viewer` is empty for callers without a stream.
  bool may_change(const std::string& viewer) const;

  /// What `by` asks for; on an error nothing has changed.
  protocol::Result<void> apply(const protocol::SessionControl& request, const std::string& by,
                               const IsPresent& is_present);
  /// A viewer who leaves takes nothing along: control is free for anybody to take.
  void left(const std::string& viewer);

 private:
  protocol::Result<void> set_mode(const protocol::SessionControl& request, const std::string& by,
                                  const IsPresent& is_present);
  protocol::Result<void> act(protocol::ControlAction action,
                             const protocol::SessionControl& request, const std::string& by,
                             const IsPresent& is_present);
  protocol::Result<void> hand_to(const std::string& viewer, const IsPresent& is_present);

  protocol::ControlMode mode_ = protocol::ControlMode::shared;
  std::string holder_;  // in mode one; empty: nobody
};

}  // namespace heliograph::session
