#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::AnimationPlay;
using protocol::AnimationRate;
using protocol::AnimationSeek;
using protocol::AnimationState;
using protocol::Empty;

void add_animation_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, AnimationState>(
      dispatcher, "animation.list",
      [&](const Empty&, const std::string&) { return host.default_session().animation(); });
  add_command<AnimationPlay, AnimationState>(
      dispatcher, "animation.play", [&](const AnimationPlay& request, const std::string&) {
        return host.default_session().play(request);
      });
  add_command<Empty, AnimationState>(
      dispatcher, "animation.pause",
      [&](const Empty&, const std::string&) { return host.default_session().pause(); });
  add_command<AnimationSeek, AnimationState>(
      dispatcher, "animation.seek", [&](const AnimationSeek& request, const std::string&) {
        return host.default_session().seek(request);
      });
  add_command<AnimationRate, AnimationState>(
      dispatcher, "animation.rate", [&](const AnimationRate& request, const std::string&) {
        return host.default_session().set_rate(request);
      });
}

}  // namespace heliograph::session
