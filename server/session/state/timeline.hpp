#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/pending_answer.hpp"
#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "session/state/render_state.hpp"
#include "session/state/ticket.hpp"

namespace heliograph::session {

/// Frames to render in lockstep.
struct StepRequest {
  std::uint32_t frames = 1;
  double dt = 0.0;  // seconds that pass before each of them
  /// The viewer that asks; empty for a caller without a stream. Dropped when the viewer leaves.
  std::string viewer;
  /// The answer to the request; the step is dropped where it is abandoned. Null: it never is.
  std::shared_ptr<const protocol::PendingAnswer> answer = nullptr;
  /// Called once, on any thread, without locks.
  std::function<void(protocol::Result<protocol::StepState>)> done;
};

/// One frame that is due in lockstep.
struct StepFrame {
  Ticket ticket = 0;        // of its step
  double seconds = 0.0;     // that pass before it
  RenderState state;        // as of the request
  bool is_current = false;  // no command came after the request
};

/// Time in a session: the clock of its animation, and lockstep, where time passes by requested
/// steps only. Not thread safe.
class Timeline {
 public:
  explicit Timeline(std::size_t max_steps) : max_steps_(max_steps) {}
  /// Takes over the clip of another session as it stands now, out of lockstep.
  void copy_from(const Timeline& other);
  /// Runs with the clip of another session; where that is in lockstep, stands where it stands.
  void follow(const Timeline& leader);

  const AnimationClock& clock() const { return clock_; }
  /// For a scene that is new.
  void reset_clock() { clock_ = {}; }
  protocol::Result<void> play(const protocol::AnimationPlay& request, const scene::Scene& scene);
  void pause();
  protocol::Result<void> seek(double seconds);
  void set_rate(double rate);
  protocol::AnimationState animation_state(const std::vector<protocol::ClipInfo>& clips,
                                           std::uint32_t rev) const;

  bool in_lockstep() const { return time_.has_value(); }
  /// The time in lockstep: since it was entered, with all requested steps.
  const std::optional<Clock::time_point>& lockstep_time() const { return time_; }
  /// How often lockstep was entered; each time rendering starts without history.
  std::uint64_t reset_count() const { return reset_count_; }
  /// The clip goes on from where it stands.
  void enter_lockstep();
  void leave_lockstep();

  /// The next sequence ticket; nothing outside lockstep, where no order is kept.
  std::optional<Ticket> next_ticket();
  /// Refused when too many are pending.
  protocol::Result<void> check_capacity() const;
  /// In lockstep. Its frames show `state`, the session's state at the request after `changes`
  /// changes; commands that come later take effect after it, with its time counted as passed.
  void add_step(StepRequest request, RenderState state, std::uint64_t changes);
  /// Lets the time of the next frame pass. Nothing where no frame is due, or where a capture or
  /// probe comes before it, the first of which has the ticket `first_read`. `changes` as above,
  /// now.
  std::optional<StepFrame> begin_step(std::optional<Ticket> first_read, std::uint64_t changes);
  /// Whether steps are due before this ticket; without one, any.
  bool step_due(std::optional<Ticket> ticket) const;
  /// After `frame` was rendered. Gives what to call with the state where its step is complete.
  std::function<void(protocol::Result<protocol::StepState>)> end_step(const StepFrame& frame,
                                                                      std::uint32_t samples);
  /// Removes steps, and the time of their frames that are not rendered.
  std::vector<StepRequest> remove_steps(const std::function<bool(const StepRequest&)>& unwanted);
  /// Calls `update` with the state of every pending step.
  void update_pending(const std::function<void(RenderState&)>& update);
  /// `time`: of lockstep; nothing outside it.
  protocol::StepState step_state(std::optional<Clock::time_point> time, std::uint32_t rev) const;

 private:
  struct PendingStep {
    StepRequest request;
    Ticket ticket = 0;
    std::uint64_t changes = 0;
    bool begun = false;  // a frame is being rendered
    RenderState state;
  };

  Clock::time_point now() const { return time_ ? *time_ : Clock::now(); }
  /// The clock as it stands, counted from now on.
  AnimationClock clock_now() const;

  const std::size_t max_steps_;
  AnimationClock clock_;
  std::optional<Clock::time_point> time_;
  std::uint64_t reset_count_ = 0;
  std::deque<PendingStep> steps_;
  Ticket last_ticket_ = 0;
  // Since lockstep was entered:
  std::uint64_t frames_ = 0;
  std::uint32_t samples_ = 0;  // of the newest frame
};

}  // namespace heliograph::session
