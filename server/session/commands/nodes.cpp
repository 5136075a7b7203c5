#include "session/commands/commands.hpp"

// The nodes of a session's scene: hierarchy, visibility and selection.

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::NodeIds;

void add_node_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::nodes_list>(
      dispatcher, host,
      [](Session& session, const protocol::NodesList& request, const std::string&) {
        return session.nodes().list(request);
      });
  add_command<methods::nodes_info>(
      dispatcher, host, [](Session& session, const NodeIds& request, const std::string&) {
        return session.nodes().properties(request);
      });
  add_command<methods::nodes_patch>(
      dispatcher, host,
      [](Session& session, const protocol::NodesPatch& request, const std::string& viewer) {
        return session.nodes().patch(request, viewer);
      });
  add_command<methods::nodes_isolate>(
      dispatcher, host, [](Session& session, const NodeIds& request, const std::string& viewer) {
        return session.nodes().isolate(request, viewer);
      });
  add_command<methods::selection_get>(
      dispatcher, host, [](Session& session, const protocol::Empty&, const std::string&) {
        return session.nodes().selection();
      });
  add_command<methods::selection_set>(
      dispatcher, host, [](Session& session, const NodeIds& request, const std::string& viewer) {
        return session.nodes().select(request, viewer);
      });
}

}  // namespace heliograph::session
