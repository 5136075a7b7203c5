#include <algorithm>
#include <cstdio>
#include <random>

#include "session/commands/commands.hpp"
#include "stream/encoders/codec_choice.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::enum_name;
using protocol::Hello;
using protocol::HelloResult;
using protocol::Result;
using protocol::StreamAck;
using protocol::StreamCodec;
using protocol::StreamConfigure;
using protocol::StreamState;
namespace error = protocol::error;

namespace {

/// Identifies this server run: clients compare it to learn whether their session still exists.
const std::string& instance() {
  static const std::string id = [] {
    std::random_device random;
    char text[17];
    std::snprintf(text, sizeof text, "%08x%08x", random(), random());
    return std::string(text);
  }();
  return id;
}

/// The session that a hello requests.
Result<std::shared_ptr<Session>> choose_session(SessionHost& host, const Hello& request,
                                                const protocol::CallContext& call) {
  if (!request.session) return host.sessions().session_of(call);
  if (call.viewer.empty()) return host.sessions().find(*request.session);
  return host.sessions().move(call.viewer, *request.session);
}

struct ChosenSession {
  std::shared_ptr<Session> session;
  std::optional<bool> restore_state;
};

/// The session of a caller from its hello on. A viewer of an earlier server run resumes in a
/// session of its own or with the viewers that were there with it; in the main session if that
/// fails.
Result<ChosenSession> resume_session(SessionHost& host, const Hello& request,
                                     const protocol::CallContext& call) {
  const bool resumes = request.instance && *request.instance != instance() && request.session;
  if (!resumes || call.viewer.empty()) {
    const auto session = choose_session(host, request, call);
    if (!session) return session.error();
    return ChosenSession{.session = *session, .restore_state = {}};
  }
  const Origin from{.instance = *request.instance, .session = *request.session};
  const auto resumed = host.resume(call.viewer, from, call.view_only);
  if (resumed) return ChosenSession{.session = resumed->session, .restore_state = resumed->first};
  const auto main = host.sessions().move(call.viewer, std::string(protocol::main_session));
  if (!main) return main.error();
  return ChosenSession{.session = *main, .restore_state = {}};
}

HelloResult greeting(SessionHost& host, const ChosenSession& chosen,
                     const protocol::CallContext& call, const stream::CodecChoice& choice) {
  const Session& session = *chosen.session;
  const render::Engine& engine = host.devices().engine(session.device());
  const render::DeviceInfo device = engine.device();
  const SessionLimits& limits = session.limits();
  HelloResult result;
  result.version = HELIOGRAPH_VERSION;
  result.device = {.name = device.name,
                   .driver = device.driver,
                   .type = device.type,
                   .index = static_cast<std::uint32_t>(session.device())};
  result.tracer = engine.tracer();
  result.session = session.name();
  result.viewer = call.viewer;
  result.role = call.view_only ? protocol::ViewerRole::view : protocol::ViewerRole::control;
  if (choice.codec != StreamCodec::jpeg) result.codecs.emplace_back(enum_name(choice.codec));
  result.codecs.emplace_back("jpeg");
  result.codec_reason = choice.reason;
  result.limits = {
      .max_width = limits.max_width,
      .max_height = limits.max_height,
      .max_message_bytes = static_cast<std::uint32_t>(host.dispatch_limits().max_message_bytes),
      .ack_window = stream::ack_window,
      .max_batch = static_cast<std::uint32_t>(host.dispatch_limits().max_batch),
      .max_pending = static_cast<std::uint32_t>(limits.max_captures),
      .max_upload_bytes = call.view_only ? 0 : host.max_upload_bytes()};
  result.annotators = host.annotators();
  result.rev = session.rev();
  result.instance = instance();
  result.restore_state = chosen.restore_state;
  return result;
}

Result<HelloResult> greet(SessionHost& host, const Hello& request,
                          const protocol::CallContext& call) {
  const auto& codecs = request.codecs;
  if (std::find(codecs.begin(), codecs.end(), "jpeg") == codecs.end()) {
    return error::invalid("codecs", "must include a codec of the server", "jpeg");
  }
  const Result<ChosenSession> chosen = resume_session(host, request, call);
  if (!chosen) return chosen.error();
  const std::shared_ptr<Session>& session = chosen->session;
  const stream::CodecChoice choice = stream::choose_codec(codecs);
  if (!call.viewer.empty()) {
    if (request.name) session->viewers().set_name(call.viewer, *request.name);
    session->viewers().start(call.viewer, choice.codec);
    session->announce();
  }
  return greeting(host, *chosen, call, choice);
}

}  // namespace

void add_stream_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  dispatcher.add<methods::hello>(
      [&](const Hello& request, const protocol::CallContext& context,
          protocol::Completion<HelloResult> done) { done(greet(host, request, context)); });
  dispatcher.add<methods::stream_configure>([&](const StreamConfigure& request,
                                                const protocol::CallContext& context,
                                                protocol::Completion<StreamState> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    done((*session)->configure_stream(request, context.viewer, context.view_only));
  });
  add_command<methods::stream_pause>(dispatcher, host,
                                     [](Session& session, const Empty&, const std::string& viewer) {
                                       return session.configure_stream({.paused = true}, viewer);
                                     });
  add_command<methods::stream_resume>(
      dispatcher, host, [](Session& session, const Empty&, const std::string& viewer) {
        return session.configure_stream({.paused = false}, viewer);
      });
  add_command<methods::stream_ack>(
      dispatcher, host,
      [](Session& session, const StreamAck& request, const std::string& viewer) -> Result<Empty> {
        const auto taken = session.viewers().acknowledge(viewer, request);
        if (!taken) return taken.error();
        return Empty();
      });
}

}  // namespace heliograph::session
