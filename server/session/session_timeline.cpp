#include "session/session_timeline.hpp"

#include <utility>
#include <vector>

namespace heliograph::session {

using protocol::AnimationState;
using protocol::Result;
using protocol::StepState;
namespace error = protocol::error;

Result<AnimationState> SessionTimeline::animation() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return core_.timeline.animation_state(core_.scene_info.clips, core_.rev);
}

Result<AnimationState> SessionTimeline::play(const protocol::AnimationPlay& request,
                                             const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const auto played = core_.timeline.play(request, *core_.scene); !played) {
    return played.error();
  }
  return publish_clock(by);
}

Result<AnimationState> SessionTimeline::pause(const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  core_.timeline.pause();
  return publish_clock(by);
}

Result<AnimationState> SessionTimeline::seek(const protocol::AnimationSeek& request,
                                             const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const auto sought = core_.timeline.seek(request.seconds); !sought) return sought.error();
  return publish_clock(by);
}

Result<AnimationState> SessionTimeline::set_rate(const protocol::AnimationRate& request,
                                                 const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  core_.timeline.set_rate(request.rate);
  return publish_clock(by);
}

AnimationState SessionTimeline::publish_clock(const std::string& by) {
  core_.changed();
  return notify_animation(by);
}

AnimationState SessionTimeline::notify_animation(const std::string& by) {
  const protocol::AnimationChanged message{
      .animation = core_.timeline.animation_state(core_.scene_info.clips, core_.rev), .by = by};
  core_.notify_others_latest<protocol::notifications::animation_changed>(by, message);
  return message.animation;
}

/// The animation is notified, too, since its clock runs differently.
void SessionTimeline::notify_lockstep(const std::string& by) {
  core_.notify_others_latest<protocol::notifications::lockstep_changed>(
      by, {.state = step_state(), .by = by});
  notify_animation(by);
}

StepState SessionTimeline::step_state() const {
  return core_.timeline.step_state(core_.timeline.lockstep_time(), core_.rev);
}

Result<void> SessionTimeline::request_step(StepRequest request) {
  std::optional<StepState> at_once;
  {
    const std::lock_guard lock(core_.mutex);
    if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
    if (const auto capacity = core_.timeline.check_capacity(); !capacity) return capacity;
    if (!core_.timeline.in_lockstep()) {
      const bool first_view_shown = core_.shows_first_view();
      core_.timeline.enter_lockstep();
      core_.changed();
      notify_lockstep(request.viewer);
      core_.tell_camera_of_other_scene(first_view_shown);
    }
    if (request.frames > 0) {
      core_.timeline.add_step(std::move(request), core_.snapshot(), core_.changes);
    } else {
      at_once = step_state();
    }
  }
  core_.wake->notify();
  if (at_once) request.done(*at_once);
  return {};
}

StepState SessionTimeline::leave_lockstep(const std::string& by) {
  std::vector<StepRequest> unfinished;
  StepState state;
  {
    const std::lock_guard lock(core_.mutex);
    unfinished = core_.timeline.remove_steps([](const StepRequest&) { return true; });
    if (core_.timeline.in_lockstep()) {
      const bool first_view_shown = core_.shows_first_view();
      core_.timeline.leave_lockstep();
      core_.changed();
      notify_lockstep(by);
      core_.tell_camera_of_other_scene(first_view_shown);
    }
    state = step_state();
  }
  for (const StepRequest& request : unfinished) {
    request.done(error::conflict("frames", "lockstep was left before the steps were finished"));
  }
  return state;
}

std::uint64_t SessionTimeline::reset_count() const {
  const std::lock_guard lock(core_.mutex);
  return core_.timeline.reset_count();
}

bool SessionTimeline::in_lockstep() const {
  const std::lock_guard lock(core_.mutex);
  return core_.timeline.in_lockstep();
}

std::optional<StepFrame> SessionTimeline::begin_step(std::optional<Ticket> first_read) {
  const std::lock_guard lock(core_.mutex);
  std::optional<StepFrame> frame =
      core_.timeline.begin_step(earliest(first_read, core_.captures.first_ticket()), core_.changes);
  if (!frame) return std::nullopt;
  frame->state.version = ++core_.version;
  if (!frame->is_current) ++core_.version;
  return frame;
}

bool SessionTimeline::step_due(std::optional<Ticket> ticket) const {
  const std::lock_guard lock(core_.mutex);
  return core_.timeline.step_due(ticket);
}

void SessionTimeline::end_step(const StepFrame& frame, std::uint32_t samples) {
  std::function<void(Result<StepState>)> done;
  StepState state;
  {
    const std::lock_guard lock(core_.mutex);
    done = core_.timeline.end_step(frame, samples);
    core_.lead();
    state = core_.timeline.step_state(frame.state.lockstep, frame.state.rev);
  }
  if (done) done(state);
}

void SessionTimeline::fail_steps(const protocol::Error& why) {
  fail_steps_where([](const StepRequest&) { return true; }, why);
}

void SessionTimeline::fail_abandoned_steps() {
  fail_steps_where([](const StepRequest& step) { return step.answer && step.answer->abandoned(); },
                   error::conflict("frames", "the caller has closed its connection"));
}

void SessionTimeline::fail_steps_of(const std::string& viewer, const protocol::Error& why) {
  fail_steps_where([&](const StepRequest& step) { return step.viewer == viewer; }, why);
}

void SessionTimeline::fail_steps_where(const std::function<bool(const StepRequest&)>& unwanted,
                                       const protocol::Error& why) {
  std::vector<StepRequest> removed;
  {
    const std::lock_guard lock(core_.mutex);
    removed = core_.timeline.remove_steps(unwanted);
  }
  for (const StepRequest& request : removed) request.done(why);
}

}  // namespace heliograph::session
