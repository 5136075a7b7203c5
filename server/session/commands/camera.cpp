#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::Camera;
using protocol::CameraSet;
using protocol::Empty;

void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, Camera>(
      dispatcher, host, "camera.get",
      [](Session& session, const Empty&, const std::string&) { return session.camera().get(); });
  add_command<CameraSet, Camera>(
      dispatcher, host, "camera.set",
      [](Session& session, const CameraSet& request, const std::string& viewer) {
        return session.camera().set(request, viewer);
      });
  add_command<protocol::CameraOrbit, Camera>(
      dispatcher, host, "camera.orbit",
      [](Session& session, const protocol::CameraOrbit& request, const std::string& viewer) {
        return session.camera().orbit(request, viewer);
      });
  add_command<Empty, Camera>(dispatcher, host, "camera.fit",
                             [](Session& session, const Empty&, const std::string& viewer) {
                               return session.camera().fit(viewer);
                             });
}

}  // namespace heliograph::session
