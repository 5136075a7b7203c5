#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::Camera;
using protocol::CameraSet;
using protocol::Empty;

void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, Camera>(dispatcher, "camera.get", [&](const Empty&, const std::string&) {
    return host.default_session().camera();
  });
  add_command<CameraSet, Camera>(dispatcher, "camera.set",
                                 [&](const CameraSet& request, const std::string& viewer) {
                                   return host.default_session().set_camera(request, viewer);
                                 });
  add_command<Empty, Camera>(dispatcher, "camera.fit",
                             [&](const Empty&, const std::string& viewer) {
                               return host.default_session().fit_camera(viewer);
                             });
}

}  // namespace heliograph::session
