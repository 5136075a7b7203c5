#include "protocol/json/jsonrpc.hpp"
#include "protocol/json/suggestions.hpp"
#include "scene/animation/pose.hpp"
#include "session/state/session.hpp"

// What moves in a session, and when.

namespace heliograph::session {

using protocol::AnimationState;
using protocol::Result;
namespace error = protocol::error;

Result<AnimationState> Session::animation() const {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  return animation_message();
}

Result<AnimationState> Session::play(const protocol::AnimationPlay& request,
                                     const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  if (scene_->clips.empty()) return error::not_found("clip", "the scene has no clips");
  AnimationClock clock = rewound_clock();
  if (request.clip) {
    std::vector<std::string_view> names;
    for (const scene::Clip& clip : scene_->clips) names.push_back(clip.name);
    if (!scene::find_clip(*scene_, *request.clip)) {
      return error::not_found(
          "clip", "the scene has no such clip" + protocol::suggestion(*request.clip, names));
    }
    clock.clip = *request.clip;
    clock.seconds = 0.0;
  } else if (clock.clip.empty()) {
    clock.clip = scene_->clips.front().name;
  }
  clock.rate = request.rate.value_or(clock.rate);
  clock.playing = true;
  return set_clock(clock, by);
}

Result<AnimationState> Session::pause(const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  AnimationClock clock = rewound_clock();
  clock.playing = false;
  return set_clock(clock, by);
}

Result<AnimationState> Session::seek(const protocol::AnimationSeek& request,
                                     const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  AnimationClock clock = rewound_clock();
  if (clock.clip.empty()) return error::not_ready("no clip is active; play one first");
  clock.seconds = request.seconds;
  return set_clock(clock, by);
}

Result<AnimationState> Session::set_rate(const protocol::AnimationRate& request,
                                         const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  AnimationClock clock = rewound_clock();
  clock.rate = request.rate;
  return set_clock(clock, by);
}

/// The clock as it stands, told from now on.
AnimationClock Session::rewound_clock() const {
  AnimationClock clock = state_.animation;
  const Clock::time_point now = state_.now();
  clock.seconds = clock.at(now);
  clock.since = now;
  return clock;
}

AnimationState Session::set_clock(const AnimationClock& clock, const std::string& by) {
  state_.animation = clock;
  changed();
  return tell_animation(by);
}

AnimationState Session::tell_animation(const std::string& by) {
  const protocol::AnimationChanged message{.animation = animation_message(), .by = by};
  viewers_.send_others(
      by, protocol::make_notification<protocol::notifications::animation_changed>(message),
      "animation.changed");
  return message.animation;
}

/// The clip's clock is another one now, too.
void Session::tell_lockstep(const std::string& by) {
  const protocol::LockstepChanged message{.state = step_message(state_), .by = by};
  viewers_.send_others(
      by, protocol::make_notification<protocol::notifications::lockstep_changed>(message),
      "lockstep.changed");
  tell_animation(by);
}

AnimationState Session::animation_message() const {
  const AnimationClock clock = rewound_clock();
  AnimationState message{.clips = scene_info_.clips,
                         .clip = std::nullopt,
                         .playing = clock.playing,
                         .seconds = clock.seconds,
                         .rate = clock.rate,
                         .lockstep = state_.lockstep.has_value(),
                         .rev = state_.rev};
  if (!clock.clip.empty()) message.clip = clock.clip;
  return message;
}

}  // namespace heliograph::session
