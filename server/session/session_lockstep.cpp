#include <utility>

#include "protocol/jsonrpc.hpp"
#include "session/session.hpp"

// Lockstep: time passes in a session only frame by frame, as somebody asks for.

namespace heliograph::session {

using protocol::Result;
using protocol::StepState;
namespace error = protocol::error;

Result<void> Session::request_step(StepRequest request) {
  std::optional<StepState> at_once;
  {
    const std::lock_guard lock(mutex_);
    if (const Result<void> there = require_scene(); !there) return there;
    if (steps_.size() >= options_.limits.max_captures) {
      return error::full("too many steps are waiting",
                         std::to_string(options_.limits.max_captures));
    }
    if (!state_.lockstep) enter_lockstep(request.by);
    if (request.frames > 0) {
      steps_.push_back(std::move(request));
    } else {
      at_once = step_message();
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
  ++state_.fresh_starts;
  step_totals_ = {};
  changed();
  tell_lockstep(by);
}

StepState Session::run_freely(const std::string& by) {
  std::vector<StepRequest> unfinished;
  StepState state;
  {
    const std::lock_guard lock(mutex_);
    if (state_.lockstep) {
      AnimationClock clock = rewound_clock();
      clock.since = Clock::now();
      state_.animation = clock;
      state_.lockstep.reset();
      changed();
      tell_lockstep(by);
    }
    unfinished = std::exchange(steps_, {});
    state = step_message();
  }
  for (const StepRequest& request : unfinished) {
    request.done(error::conflict("frames", "somebody let time run freely before they were done"));
  }
  return state;
}

bool Session::in_lockstep() const {
  const std::lock_guard lock(mutex_);
  return state_.lockstep.has_value();
}

std::optional<double> Session::begin_step() {
  const std::lock_guard lock(mutex_);
  if (!state_.lockstep || steps_.empty()) return std::nullopt;
  const double dt = steps_.front().dt;
  *state_.lockstep += std::chrono::round<Clock::duration>(std::chrono::duration<double>(dt));
  ++state_.version;
  return dt;
}

bool Session::step_due() const {
  const std::lock_guard lock(mutex_);
  return state_.lockstep && !steps_.empty();
}

void Session::end_step(std::uint32_t samples) {
  std::function<void(Result<StepState>)> done;
  StepState state;
  {
    const std::lock_guard lock(mutex_);
    if (steps_.empty()) return;
    ++step_totals_.frames;
    step_totals_.samples = samples;
    StepRequest& step = steps_.front();
    if (--step.frames > 0) return;
    done = std::move(step.done);
    steps_.erase(steps_.begin());
    state = step_message();
  }
  done(state);
}

void Session::fail_steps(const protocol::Error& why) {
  std::vector<StepRequest> unfinished;
  {
    const std::lock_guard lock(mutex_);
    unfinished = std::exchange(steps_, {});
  }
  for (const StepRequest& request : unfinished) request.done(why);
}

StepState Session::step_message() const {
  StepState state{.lockstep = state_.lockstep.has_value(),
                  .frames = step_totals_.frames,
                  .samples = step_totals_.samples,
                  .rev = state_.rev};
  if (state_.lockstep) {
    state.seconds = std::chrono::duration<double>(state_.lockstep->time_since_epoch()).count();
  }
  return state;
}

}  // namespace heliograph::session
