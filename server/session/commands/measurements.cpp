#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;

void add_measurement_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::measurements_list>(
      dispatcher, host, [](Session& session, const Empty&, const std::string&) {
        return protocol::Result<protocol::MeasurementList>(session.measurements().list());
      });
  add_command<methods::measurements_add>(
      dispatcher, host,
      [](Session& session, const protocol::MeasurementAdd& request, const std::string& viewer) {
        return session.measurements().add(request, viewer);
      });
  add_command<methods::measurements_remove>(
      dispatcher, host,
      [](Session& session, const protocol::MeasurementId& request, const std::string& viewer) {
        return session.measurements().remove(request, viewer);
      });
  add_command<methods::measurements_clear>(
      dispatcher, host, [](Session& session, const Empty&, const std::string& viewer) {
        return session.measurements().clear(viewer);
      });
  add_command<methods::measurements_unit>(
      dispatcher, host,
      [](Session& session, const protocol::MeasurementUnit& request, const std::string& viewer) {
        return session.measurements().set_unit(request, viewer);
      });
}

}  // namespace heliograph::session
