#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;

void add_annotation_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::annotations_list>(
      dispatcher, host, [](Session& session, const Empty&, const std::string&) {
        return protocol::Result<protocol::AnnotationList>(session.annotations().list());
      });
  add_command<methods::annotations_add>(
      dispatcher, host,
      [](Session& session, const protocol::AnnotationAdd& request, const std::string& viewer) {
        return session.annotations().add(request, viewer);
      });
  add_command<methods::annotations_edit>(
      dispatcher, host,
      [](Session& session, const protocol::AnnotationEdit& request, const std::string& viewer) {
        return session.annotations().edit(request, viewer);
      });
  add_command<methods::annotations_remove>(
      dispatcher, host,
      [](Session& session, const protocol::AnnotationId& request, const std::string& viewer) {
        return session.annotations().remove(request, viewer);
      });
  add_command<methods::annotations_clear>(
      dispatcher, host, [](Session& session, const Empty&, const std::string& viewer) {
        return session.annotations().clear(viewer);
      });
}

}  // namespace heliograph::session
