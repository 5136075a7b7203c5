#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::AnimationPlay;
using protocol::AnimationRate;
using protocol::AnimationSeek;
using protocol::AnimationState;
using protocol::Empty;

void add_animation_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, AnimationState>(dispatcher, host, "animation.list",
                                     [](Session& session, const Empty&, const std::string&) {
                                       return session.timeline().animation();
                                     });
  add_command<AnimationPlay, AnimationState>(
      dispatcher, host, "animation.play",
      [](Session& session, const AnimationPlay& request, const std::string& viewer) {
        return session.timeline().play(request, viewer);
      });
  add_command<Empty, AnimationState>(dispatcher, host, "animation.pause",
                                     [](Session& session, const Empty&, const std::string& viewer) {
                                       return session.timeline().pause(viewer);
                                     });
  add_command<AnimationSeek, AnimationState>(
      dispatcher, host, "animation.seek",
      [](Session& session, const AnimationSeek& request, const std::string& viewer) {
        return session.timeline().seek(request, viewer);
      });
  add_command<AnimationRate, AnimationState>(
      dispatcher, host, "animation.rate",
      [](Session& session, const AnimationRate& request, const std::string& viewer) {
        return session.timeline().set_rate(request, viewer);
      });
}

}  // namespace heliograph::session
