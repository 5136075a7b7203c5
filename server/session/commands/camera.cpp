#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Camera;
using protocol::CameraSet;
using protocol::Empty;

namespace {

/// Adds a command that moves the camera; a viewer that moves its own follows no other one any more.
template <class Method, class Command>
void add_movement(protocol::Dispatcher& dispatcher, SessionHost& host, Command command) {
  add_command<Method>(dispatcher, host,
                      [&host, command](Session& session, const typename Method::Params& request,
                                       const std::string& viewer) {
                        if (!session.follows().empty()) host.sessions().stop_following(viewer);
                        return command(session, request, viewer);
                      });
}

}  // namespace

void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::camera_get>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.camera().get(); });
  add_movement<methods::camera_set>(
      dispatcher, host, [](Session& session, const CameraSet& request, const std::string& viewer) {
        return session.camera().set(request, viewer);
      });
  add_movement<methods::camera_orbit>(
      dispatcher, host,
      [](Session& session, const protocol::CameraOrbit& request, const std::string& viewer) {
        return session.camera().orbit(request, viewer);
      });
  add_movement<methods::camera_fit>(
      dispatcher, host,
      [](Session& session, const protocol::CameraFit& request, const std::string& viewer) {
        return session.camera().fit(request, viewer);
      });
  add_bookmark_commands(dispatcher, host);
}

}  // namespace heliograph::session
