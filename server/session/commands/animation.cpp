#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::AnimationPlay;
using protocol::AnimationRate;
using protocol::AnimationSeek;
using protocol::AnimationState;
using protocol::Empty;

void add_animation_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::animation_list>(dispatcher, host,
                                       [](Session& session, const Empty&, const std::string&) {
                                         return session.timeline().animation();
                                       });
  add_command<methods::animation_play>(
      dispatcher, host,
      [](Session& session, const AnimationPlay& request, const std::string& viewer) {
        return session.timeline().play(request, viewer);
      });
  add_command<methods::animation_pause>(
      dispatcher, host, [](Session& session, const Empty&, const std::string& viewer) {
        return session.timeline().pause(viewer);
      });
  add_command<methods::animation_seek>(
      dispatcher, host,
      [](Session& session, const AnimationSeek& request, const std::string& viewer) {
        return session.timeline().seek(request, viewer);
      });
  add_command<methods::animation_rate>(
      dispatcher, host,
      [](Session& session, const AnimationRate& request, const std::string& viewer) {
        return session.timeline().set_rate(request, viewer);
      });
}

}  // namespace heliograph::session
