#include "session/viewers/control.hpp"

namespace heliograph::session {

using protocol::ControlAction;
using protocol::ControlMode;
using protocol::Result;
using protocol::SessionControl;
namespace error = protocol::error;

namespace {

protocol::Error forbidden(std::string reason) {
  return error::make(protocol::ErrorCode::forbidden, "control", std::move(reason));
}

}  // namespace

bool Control::may_change(const std::string& viewer) const {
  return mode_ == ControlMode::shared || holder_ == viewer;
}

Result<void> Control::apply(const SessionControl& request, const std::string& by,
                            const IsPresent& is_present) {
  if (!request.mode && !request.action) {
    return error::invalid("mode", "or action is required");
  }
  Control changed = *this;
  if (request.mode) {
    if (const auto set = changed.set_mode(request, by, is_present); !set) return set;
  }
  if (request.action) {
    if (const auto done = changed.act(*request.action, request, by, is_present); !done) return done;
  }
  *this = changed;
  return {};
}

void Control::on_viewer_left(const std::string& viewer) {
  if (holder_ == viewer) holder_.clear();
}

Result<void> Control::set_mode(const SessionControl& request, const std::string& by,
                               const IsPresent& is_present) {
  const bool free = holder_.empty();
  if (!by.empty() && !may_change(by) && !free) {
    return forbidden("only the viewer that has control can change its mode");
  }
  const bool keeps_control = mode_ == ControlMode::shared || holder_ == by;
  if (*request.mode == mode_ && !request.viewer && keeps_control) return {};
  mode_ = *request.mode;
  holder_.clear();
  if (mode_ == ControlMode::shared) return {};
  const std::string& holder = request.viewer.value_or(by);
  if (holder.empty()) return {};
  return hand_to(holder, is_present);
}

Result<void> Control::act(ControlAction action, const SessionControl& request,
                          const std::string& by, const IsPresent& is_present) {
  if (mode_ == ControlMode::shared) {
    return error::conflict("action", "all viewers have control; set mode to exclusive first");
  }
  const bool may_assign = by.empty() || holder_ == by;
  switch (action) {
    case ControlAction::take:
      if (by.empty()) return error::not_ready("requires a WebSocket connection");
      if (!holder_.empty() && holder_ != by) {
        return forbidden("another viewer has control and has not released it");
      }
      return hand_to(by, is_present);
    case ControlAction::give:
      if (!request.viewer) return error::invalid("viewer", "is required to give control");
      if (!may_assign) return forbidden("only the viewer that has control can give it");
      return hand_to(*request.viewer, is_present);
    case ControlAction::release:
      if (!may_assign) return forbidden("only the viewer that has control can release it");
      holder_.clear();
      return {};
  }
  return error::internal();
}

Result<void> Control::hand_to(const std::string& viewer, const IsPresent& is_present) {
  if (!is_present(viewer)) {
    return error::not_found("viewer", "is not a viewer of this session that may have control");
  }
  holder_ = viewer;
  return {};
}

}  // namespace heliograph::session
