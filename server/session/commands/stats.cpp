#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Result;
using protocol::StatsSubscription;

void add_stats_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::stats_subscribe>(
      dispatcher, host,
      [](Session& session, const StatsSubscription& request,
         const std::string& viewer) -> Result<StatsSubscription> {
        const auto subscribed =
            session.viewers().subscribe(viewer, std::chrono::milliseconds(request.interval_ms));
        if (!subscribed) return subscribed.error();
        return request;
      });
}

}  // namespace heliograph::session
