#include <algorithm>
#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "session/state/session.hpp"

// Lockstep: time passes in a session only frame by frame, as somebody asks for.

namespace heliograph::session {

using protocol::Result;
using protocol::StepState;
namespace error = protocol::error;

namespace {

Clock::duration time_between(const StepRequest& step) {
  return std::chrono::round<Clock::duration>(std::chrono::duration<double>(step.dt));
}

Clock::duration time_left(const StepRequest& step) {
  return time_between(step) * step.frames;
}

}  // namespace

/// Commands that come while the step is due take effect after it: its frames show the state as it
/// is now, and time counts as passed from now on.
Result<void> Session::request_step(StepRequest request) {
  std::optional<StepState> at_once;
  {
    const std::lock_guard lock(mutex_);
    if (const Result<void> there = require_scene(); !there) return there;
    if (steps_.size() >= options_.limits.max_captures) {
      return error::full("too many steps are pending",
                         std::to_string(options_.limits.max_captures));
    }
    if (!state_.lockstep) enter_lockstep(request.viewer);
    if (request.frames > 0) {
      DueStep step{.request = std::move(request),
                   .place = ++places_,
                   .changes = changes_,
                   .state = whole_state()};
      *state_.lockstep += time_left(step.request);
      steps_.push_back(std::move(step));
    } else {
      at_once = step_message(state_);
    }
  }
  changed_->notify();
  if (at_once) request.done(*at_once);
  return {};
}

/// The clip goes on from where it stands; what comes then is as if nothing had been drawn before.
void Session::enter_lockstep(const std::string& by) {
  AnimationClock clock = rewound_clock();
  state_.lockstep = Clock::time_point();
  clock.since = *state_.lockstep;
  state_.animation = clock;
  ++state_.reset_count;
  step_totals_ = {};
  changed();
  tell_lockstep(by);
}

StepState Session::run_freely(const std::string& by) {
  std::vector<StepRequest> unfinished;
  StepState state;
  {
    const std::lock_guard lock(mutex_);
    unfinished = take_steps([](const StepRequest&) { return true; });
    if (state_.lockstep) {
      AnimationClock clock = rewound_clock();
      clock.since = Clock::now();
      state_.animation = clock;
      state_.lockstep.reset();
      changed();
      tell_lockstep(by);
    }
    state = step_message(state_);
  }
  for (const StepRequest& request : unfinished) {
    request.done(error::conflict("frames", "lockstep was left before the steps were finished"));
  }
  return state;
}

bool Session::in_lockstep() const {
  const std::lock_guard lock(mutex_);
  return state_.lockstep.has_value();
}

std::optional<std::uint64_t> Session::next_place() {
  if (!state_.lockstep) return std::nullopt;
  return ++places_;
}

/// Whether something that the render thread does not know of yet reads what is drawn before a step.
bool Session::is_read_before(std::uint64_t place) const {
  const auto earlier = [&](const auto& waiting) { return waiting.place && *waiting.place < place; };
  return std::any_of(captures_.begin(), captures_.end(), earlier) ||
         std::any_of(probes_.begin(), probes_.end(), earlier);
}

std::optional<StepFrame> Session::begin_step(std::optional<std::uint64_t> waiting) {
  const std::lock_guard lock(mutex_);
  if (!state_.lockstep || steps_.empty()) return std::nullopt;
  DueStep& step = steps_.front();
  if ((waiting && *waiting < step.place) || is_read_before(step.place)) return std::nullopt;
  // A frame that was lost with its device is drawn again, at the same time.
  if (!std::exchange(step.begun, true)) *step.state.lockstep += time_between(step.request);
  StepFrame frame{.place = step.place, .seconds = step.request.dt, .state = step.state};
  frame.state.version = ++state_.version;
  // The frame is not of the newest state then.
  if (step.changes != changes_) ++state_.version;
  return frame;
}

bool Session::step_due(std::optional<std::uint64_t> place) const {
  const std::lock_guard lock(mutex_);
  return state_.lockstep && !steps_.empty() && (!place || steps_.front().place < *place);
}

void Session::end_step(const StepFrame& frame, std::uint32_t samples) {
  std::function<void(Result<StepState>)> done;
  StepState state;
  {
    const std::lock_guard lock(mutex_);
    ++step_totals_.frames;
    step_totals_.samples = samples;
    if (steps_.empty() || steps_.front().place != frame.place) return;
    DueStep& step = steps_.front();
    step.begun = false;
    if (--step.request.frames > 0) return;
    done = std::move(step.request.done);
    steps_.pop_front();
    state = step_message(frame.state);
  }
  done(state);
}

void Session::fail_steps(const protocol::Error& why) {
  drop_steps(why, [](const StepRequest&) { return true; });
}

void Session::drop_steps(const protocol::Error& why,
                         const std::function<bool(const StepRequest&)>& unwanted) {
  std::vector<StepRequest> dropped;
  {
    const std::lock_guard lock(mutex_);
    dropped = take_steps(unwanted);
  }
  for (const StepRequest& request : dropped) request.done(why);
}

/// The time of frames that are not drawn does not pass.
std::vector<StepRequest> Session::take_steps(
    const std::function<bool(const StepRequest&)>& unwanted) {
  std::vector<StepRequest> taken;
  std::deque<DueStep> kept;
  Clock::duration lost{};
  for (DueStep& step : steps_) {
    *step.state.lockstep -= lost;
    if (unwanted(step.request)) {
      lost += time_left(step.request);
      if (step.begun) lost -= time_between(step.request);
      taken.push_back(std::move(step.request));
    } else {
      kept.push_back(std::move(step));
    }
  }
  steps_.swap(kept);
  if (state_.lockstep) *state_.lockstep -= lost;
  return taken;
}

StepState Session::step_message(const RenderState& shown) const {
  StepState state{.lockstep = shown.lockstep.has_value(),
                  .frames = step_totals_.frames,
                  .samples = step_totals_.samples,
                  .rev = shown.rev};
  if (shown.lockstep) {
    state.seconds = std::chrono::duration<double>(shown.lockstep->time_since_epoch()).count();
  }
  return state;
}

}  // namespace heliograph::session
