#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Camera;
using protocol::CameraSet;
using protocol::Empty;

void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::camera_get>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.camera().get(); });
  add_command<methods::camera_set>(
      dispatcher, host, [](Session& session, const CameraSet& request, const std::string& viewer) {
        return session.camera().set(request, viewer);
      });
  add_command<methods::camera_orbit>(
      dispatcher, host,
      [](Session& session, const protocol::CameraOrbit& request, const std::string& viewer) {
        return session.camera().orbit(request, viewer);
      });
  add_command<methods::camera_fit>(
      dispatcher, host,
      [](Session& session, const protocol::CameraFit& request, const std::string& viewer) {
        return session.camera().fit(request, viewer);
      });
  add_bookmark_commands(dispatcher, host);
}

}  // namespace heliograph::session
