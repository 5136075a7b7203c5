#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Camera;
using protocol::CameraSet;
using protocol::Empty;

void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::camera_get>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.camera(); });
  add_command<methods::camera_set>(
      dispatcher, host, [](Session& session, const CameraSet& request, const std::string& viewer) {
        return session.set_camera(request, viewer);
      });
  add_command<methods::camera_orbit>(
      dispatcher, host,
      [](Session& session, const protocol::CameraOrbit& request, const std::string& viewer) {
        return session.orbit_camera(request, viewer);
      });
  add_command<methods::camera_fit>(dispatcher, host,
                                   [](Session& session, const Empty&, const std::string& viewer) {
                                     return session.fit_camera(viewer);
                                   });
}

}  // namespace heliograph::session
