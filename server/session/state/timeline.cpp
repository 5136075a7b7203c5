#include "session/state/timeline.hpp"

#include <utility>

#include "protocol/json/suggestions.hpp"
#include "scene/animation/pose.hpp"

namespace heliograph::session {

using protocol::Result;
using protocol::StepState;
namespace error = protocol::error;

namespace {

Clock::duration frame_interval(const StepRequest& step) {
  return std::chrono::round<Clock::duration>(std::chrono::duration<double>(step.dt));
}

Clock::duration time_left(const StepRequest& step) {
  return frame_interval(step) * step.frames;
}

}  // namespace

void Timeline::copy_from(const Timeline& other) {
  clock_ = other.clock_now();
  clock_.since = Clock::now();
  reset_count_ = other.reset_count_;
  time_.reset();
}

void Timeline::follow(const Timeline& leader) {
  clock_ = leader.clock_;
  if (!leader.in_lockstep()) return;
  clock_ = leader.clock_now();
  clock_.playing = false;
}

Result<void> Timeline::play(const protocol::AnimationPlay& request, const scene::Scene& scene) {
  if (scene.clips.empty()) return error::not_found("clip", "the scene has no clips");
  AnimationClock clock = clock_now();
  if (request.clip) {
    std::vector<std::string_view> names;
    for (const scene::Clip& clip : scene.clips) names.push_back(clip.name);
    if (!scene::find_clip(scene, *request.clip)) {
      return error::not_found(
          "clip", "the scene has no such clip" + protocol::suggestion(*request.clip, names));
    }
    clock.clip = *request.clip;
    clock.seconds = 0.0;
  } else if (clock.clip.empty()) {
    clock.clip = scene.clips.front().name;
  }
  clock.rate = request.rate.value_or(clock.rate);
  clock.playing = true;
  clock_ = std::move(clock);
  return {};
}

void Timeline::pause() {
  clock_ = clock_now();
  clock_.playing = false;
}

Result<void> Timeline::seek(double seconds) {
  if (clock_.clip.empty()) return error::not_ready("no clip is active; play one first");
  clock_ = clock_now();
  clock_.seconds = seconds;
  return {};
}

void Timeline::set_rate(double rate) {
  clock_ = clock_now();
  clock_.rate = rate;
}

AnimationClock Timeline::clock_now() const {
  AnimationClock clock = clock_;
  clock.since = now();
  clock.seconds = clock_.at(clock.since);
  return clock;
}

protocol::AnimationState Timeline::animation_state(const std::vector<protocol::ClipInfo>& clips,
                                                   std::uint32_t rev) const {
  protocol::AnimationState state{.clips = clips,
                                 .clip = std::nullopt,
                                 .playing = clock_.playing,
                                 .seconds = clock_now().seconds,
                                 .rate = clock_.rate,
                                 .lockstep = in_lockstep(),
                                 .rev = rev};
  if (!clock_.clip.empty()) state.clip = clock_.clip;
  return state;
}

void Timeline::enter_lockstep() {
  clock_ = clock_now();
  time_ = Clock::time_point();
  clock_.since = *time_;
  ++reset_count_;
  frames_ = 0;
  samples_ = 0;
}

void Timeline::leave_lockstep() {
  clock_ = clock_now();
  clock_.since = Clock::now();
  time_.reset();
}

std::optional<Ticket> Timeline::next_ticket() {
  if (!in_lockstep()) return std::nullopt;
  return ++last_ticket_;
}

Result<void> Timeline::check_capacity() const {
  if (steps_.size() < max_steps_) return {};
  return error::full("too many steps are pending", std::to_string(max_steps_));
}

void Timeline::add_step(StepRequest request, RenderState state, std::uint64_t changes) {
  *time_ += time_left(request);
  steps_.push_back({.request = std::move(request),
                    .ticket = ++last_ticket_,
                    .changes = changes,
                    .state = std::move(state)});
}

std::optional<StepFrame> Timeline::begin_step(std::optional<Ticket> first_read,
                                              std::uint64_t changes) {
  if (!in_lockstep() || steps_.empty()) return std::nullopt;
  PendingStep& step = steps_.front();
  if (first_read && *first_read < step.ticket) return std::nullopt;
  // A frame that was lost with its device is rendered again, at the same time.
  if (!std::exchange(step.begun, true)) *step.state.lockstep += frame_interval(step.request);
  return StepFrame{.ticket = step.ticket,
                   .seconds = step.request.dt,
                   .state = step.state,
                   .is_current = step.changes == changes};
}

bool Timeline::step_due(std::optional<Ticket> ticket) const {
  return in_lockstep() && !steps_.empty() && (!ticket || steps_.front().ticket < *ticket);
}

std::function<void(Result<StepState>)> Timeline::end_step(const StepFrame& frame,
                                                          std::uint32_t samples) {
  ++frames_;
  samples_ = samples;
  if (steps_.empty() || steps_.front().ticket != frame.ticket) return nullptr;
  PendingStep& step = steps_.front();
  step.begun = false;
  if (--step.request.frames > 0) return nullptr;
  auto done = std::move(step.request.done);
  steps_.pop_front();
  return done;
}

std::vector<StepRequest> Timeline::remove_steps(
    const std::function<bool(const StepRequest&)>& unwanted) {
  std::vector<StepRequest> removed;
  std::deque<PendingStep> kept;
  Clock::duration removed_time{};
  for (PendingStep& step : steps_) {
    *step.state.lockstep -= removed_time;
    if (unwanted(step.request)) {
      removed_time += time_left(step.request);
      if (step.begun) removed_time -= frame_interval(step.request);
      removed.push_back(std::move(step.request));
    } else {
      kept.push_back(std::move(step));
    }
  }
  steps_.swap(kept);
  if (time_) *time_ -= removed_time;
  return removed;
}

void Timeline::update_pending(const std::function<void(RenderState&)>& update) {
  for (PendingStep& step : steps_) update(step.state);
}

StepState Timeline::step_state(std::optional<Clock::time_point> time, std::uint32_t rev) const {
  StepState state{.lockstep = time.has_value(), .frames = frames_, .samples = samples_, .rev = rev};
  if (time) state.seconds = std::chrono::duration<double>(time->time_since_epoch()).count();
  return state;
}

}  // namespace heliograph::session
