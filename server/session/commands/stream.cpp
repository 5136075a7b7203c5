#include <algorithm>

#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::Empty;
using protocol::Hello;
using protocol::HelloResult;
using protocol::Result;
using protocol::StreamAck;
using protocol::StreamConfigure;
using protocol::StreamState;
namespace error = protocol::error;

namespace {

Result<HelloResult> greet(SessionHost& host, const Hello& request, const std::string& viewer) {
  const std::shared_ptr<Session> session = host.find_session(request.session);
  if (!session) return error::not_found("session", "does not exist");
  const auto& codecs = request.codecs;
  if (std::find(codecs.begin(), codecs.end(), "jpeg") == codecs.end()) {
    return error::invalid("codecs", "must hold one that the server has", "jpeg");
  }
  if (!viewer.empty()) session->audience().start(viewer);

  const render::DeviceInfo& device = host.engine().device();
  const SessionLimits& limits = session->limits();
  HelloResult result;
  result.version = HELIOGRAPH_VERSION;
  result.device = {.name = device.name, .driver = device.driver, .type = device.type};
  result.tracer = host.engine().tracer();
  result.session = session->name();
  result.viewer = viewer;
  result.codecs = {"jpeg"};
  result.limits = {
      .max_width = limits.max_width,
      .max_height = limits.max_height,
      .max_message_bytes = static_cast<std::uint32_t>(host.dispatch_limits().max_message_bytes),
      .ack_window = stream::ack_window};
  result.rev = session->rev();
  return result;
}

}  // namespace

void add_stream_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Hello, HelloResult>(dispatcher, "hello",
                                  [&](const Hello& request, const std::string& viewer) {
                                    return greet(host, request, viewer);
                                  });
  add_command<StreamConfigure, StreamState>(
      dispatcher, "stream.configure",
      [&](const StreamConfigure& request, const std::string& viewer) {
        return host.default_session().configure_stream(request, viewer);
      });
  add_command<StreamAck, Empty>(
      dispatcher, "stream.ack",
      [&](const StreamAck& request, const std::string& viewer) -> Result<Empty> {
        const auto taken = host.default_session().audience().acknowledge(viewer, request);
        if (!taken) return taken.error();
        return Empty();
      });
}

}  // namespace heliograph::session
