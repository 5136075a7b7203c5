#include "session/commands/commands.hpp"

// The planes that cut a session's scene open.

namespace heliograph::session {

namespace methods = protocol::methods;

void add_section_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::section_get>(
      dispatcher, host, [](Session& session, const protocol::Empty&, const std::string&) {
        return session.scene().section();
      });
  add_command<methods::section_set>(
      dispatcher, host,
      [](Session& session, const protocol::Section& request, const std::string& viewer) {
        return session.scene().set_section(request, viewer);
      });
}

}  // namespace heliograph::session
