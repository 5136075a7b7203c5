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

/// The session that a caller who introduces itself wants to be in.
Result<std::shared_ptr<Session>> choose_session(SessionHost& host, const Hello& request,
                                                const protocol::CallContext& call) {
  if (!request.session) return host.sessions().session_of(call);
  if (call.viewer.empty()) return host.sessions().find(*request.session);
  return host.sessions().move(call.viewer, *request.session);
}

Result<HelloResult> greet(SessionHost& host, const Hello& request,
                          const protocol::CallContext& call) {
  const auto& codecs = request.codecs;
  if (std::find(codecs.begin(), codecs.end(), "jpeg") == codecs.end()) {
    return error::invalid("codecs", "must hold one that the server has", "jpeg");
  }
  const Result<std::shared_ptr<Session>> chosen = choose_session(host, request, call);
  if (!chosen) return chosen.error();
  const std::shared_ptr<Session>& session = *chosen;
  if (!call.viewer.empty()) session->audience().start(call.viewer);

  const render::DeviceInfo& device = host.engine().device();
  const SessionLimits& limits = session->limits();
  HelloResult result;
  result.version = HELIOGRAPH_VERSION;
  result.device = {.name = device.name, .driver = device.driver, .type = device.type};
  result.tracer = host.engine().tracer();
  result.session = session->name();
  result.viewer = call.viewer;
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
  dispatcher.add<Hello, HelloResult>(
      "hello",
      [&](const Hello& request, const protocol::CallContext& context,
          protocol::Completion<HelloResult> done) { done(greet(host, request, context)); });
  add_command<StreamConfigure, StreamState>(
      dispatcher, host, "stream.configure",
      [](Session& session, const StreamConfigure& request, const std::string& viewer) {
        return session.configure_stream(request, viewer);
      });
  add_command<StreamAck, Empty>(
      dispatcher, host, "stream.ack",
      [](Session& session, const StreamAck& request, const std::string& viewer) -> Result<Empty> {
        const auto taken = session.audience().acknowledge(viewer, request);
        if (!taken) return taken.error();
        return Empty();
      });
}

}  // namespace heliograph::session
