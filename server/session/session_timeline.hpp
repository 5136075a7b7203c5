#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the time of a session: its animation, and lockstep. Thread safe. `by` is the viewer
/// that asks, empty for a caller without a stream.
class SessionTimeline {
 public:
  explicit SessionTimeline(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::AnimationState> animation() const;
  protocol::Result<protocol::AnimationState> play(const protocol::AnimationPlay& request,
                                                  const std::string& by = {});
  protocol::Result<protocol::AnimationState> pause(const std::string& by = {});
  protocol::Result<protocol::AnimationState> seek(const protocol::AnimationSeek& request,
                                                  const std::string& by = {});
  protocol::Result<protocol::AnimationState> set_rate(const protocol::AnimationRate& request,
                                                      const std::string& by = {});

  /// Enters lockstep where the session is not in it: frames from then on are rendered without
  /// history, and depend on nothing but the state and the steps.
  protocol::Result<void> request_step(StepRequest request);
  /// Leaves lockstep; pending steps fail.
  protocol::StepState leave_lockstep(const std::string& by = {});
  /// Grows each time that lockstep is entered.
  std::uint64_t reset_count() const;
  bool in_lockstep() const;

  /// For the render thread: lets the time of the next frame pass. Nothing where none is due, or
  /// where a capture or probe comes before it: `first_read` is the first ticket of those that the
  /// render thread has taken. After the frame was rendered comes end_step.
  std::optional<StepFrame> begin_step(std::optional<Ticket> first_read);
  /// Whether steps are due before this ticket; without one, any.
  bool step_due(std::optional<Ticket> ticket) const;
  void end_step(const StepFrame& frame, std::uint32_t samples);
  /// All pending steps fail.
  void fail_steps(const protocol::Error& why);
  /// Those whose caller has gone fail.
  void fail_abandoned_steps();
  /// Those of this viewer fail.
  void fail_steps_of(const std::string& viewer, const protocol::Error& why);

 private:
  protocol::AnimationState publish_clock(const std::string& by);
  protocol::AnimationState notify_animation(const std::string& by);
  void notify_lockstep(const std::string& by);
  protocol::StepState step_state() const;
  void fail_steps_where(const std::function<bool(const StepRequest&)>& unwanted,
                        const protocol::Error& why);

  SessionCore& core_;
};

}  // namespace heliograph::session
