#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Completion;
using protocol::Empty;
using protocol::PointerSet;
using protocol::Result;
using protocol::SessionChoice;
using protocol::SessionControl;
using protocol::SessionCreate;
using protocol::SessionInfo;
using protocol::SessionJoined;
using protocol::SessionList;
using protocol::ViewerFollow;
namespace error = protocol::error;

namespace {

Result<SessionJoined> joined_session(const Result<std::shared_ptr<Session>>& session,
                                     const std::string& viewer) {
  if (!session) return session.error();
  SessionJoined joined;
  joined.info = (*session)->info(viewer);
  joined.session = joined.info.name;
  joined.viewer = viewer;
  joined.rev = joined.info.rev;
  return joined;
}

SessionList list_sessions(const SessionHost& host, const std::string& viewer) {
  const RegistryLimits& limits = host.sessions().limits();
  SessionList list;
  for (const auto& session : host.sessions().all()) list.sessions.push_back(session->info(viewer));
  list.limits = {
      .sessions = static_cast<std::uint32_t>(limits.sessions),
      .viewers = static_cast<std::uint32_t>(limits.viewers),
      .session_viewers = static_cast<std::uint32_t>(host.sessions().main()->limits().max_viewers),
      .pixels = limits.pixels,
      .pixels_used = host.sessions().pixels_used(),
      .idle_timeout = static_cast<std::uint32_t>(limits.idle_timeout.count())};
  return list;
}

Result<Empty> follow(SessionRegistry& sessions, const ViewerFollow& request,
                     const std::string& viewer) {
  if (!request.viewer) {
    sessions.stop_following(viewer);
    return Empty();
  }
  if (const auto followed = sessions.follow(viewer, *request.viewer); !followed) {
    return followed.error();
  }
  return Empty();
}

/// Viewers can close the session that they control; any client can close an empty one.
Result<void> may_close(SessionHost& host, const SessionChoice& request, const std::string& viewer) {
  const auto session = host.sessions().find(request.session);
  if (!session) return session.error();
  if (*session == host.sessions().main()) return SessionRegistry::main_always_exists();
  const bool inside = host.sessions().session_of_viewer(viewer) == *session;
  const bool empty = (*session)->viewers().empty();
  if (!viewer.empty() && !empty && !inside) {
    return error::make(protocol::ErrorCode::forbidden, "session",
                       "other viewers are in this session");
  }
  const ViewerSet& viewers = (*session)->viewers();
  if (inside && !viewers.may_change(viewer)) return no_control(viewers);
  return {};
}

/// Answers first, since the viewers of the session are disconnected.
void close(SessionHost& host, const SessionChoice& request, const std::string& viewer,
           const Completion<Empty>& done) {
  if (const auto may = may_close(host, request, viewer); !may) return done(may.error());
  done(Empty());
  // Another client may have closed it already.
  (void)host.sessions().close(request.session, "the session was closed");
}

}  // namespace

void add_session_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  dispatcher.add<methods::session_create>([&](const SessionCreate& request,
                                              const protocol::CallContext& context,
                                              Completion<SessionInfo> done) {
    host.create_session(request, context.viewer,
                        [done = std::move(done),
                         viewer = context.viewer](const Result<std::shared_ptr<Session>>& session) {
                          if (!session) return done(session.error());
                          done((*session)->info(viewer));
                        });
  });
  add_command<methods::session_join>(
      dispatcher, host, [&](Session&, const SessionChoice& request, const std::string& viewer) {
        return joined_session(host.sessions().move(viewer, request.session), viewer);
      });
  add_command<methods::session_detach>(dispatcher, host,
                                       [&](Session&, const Empty&, const std::string& viewer) {
                                         return joined_session(host.detach(viewer), viewer);
                                       });
  add_command<methods::viewer_follow>(
      dispatcher, host, [&](Session&, const ViewerFollow& request, const std::string& viewer) {
        return follow(host.sessions(), request, viewer);
      });
  add_command<methods::pointer_set>(
      dispatcher, host,
      [&](Session&, const PointerSet& request, const std::string& viewer) -> Result<Empty> {
        const auto shown = host.sessions().point(viewer, request.position);
        if (!shown) return shown.error();
        return Empty();
      });
  add_command<methods::session_list>(
      dispatcher, host,
      [&](Session&, const Empty&, const std::string& viewer) -> Result<SessionList> {
        return list_sessions(host, viewer);
      });
  add_command<methods::session_info>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string& viewer) -> Result<SessionInfo> {
        return session.info(viewer);
      });
  add_command<methods::session_control>(dispatcher, host,
                                        [](Session& session, const SessionControl& request,
                                           const std::string& viewer) -> Result<SessionInfo> {
                                          const auto changed =
                                              session.viewers().change_control(request, viewer);
                                          if (!changed) return changed.error();
                                          session.announce();
                                          return session.info(viewer);
                                        });
  dispatcher.add<methods::session_close>(
      [&](const SessionChoice& request, const protocol::CallContext& context,
          const Completion<Empty>& done) { close(host, request, context.viewer, done); });
}

}  // namespace heliograph::session
