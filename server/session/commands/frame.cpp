#include "session/commands/commands.hpp"

// Frames on request: lockstep, and the path traced reference.

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::FrameStep;
using protocol::ReferenceStart;
using protocol::ReferenceState;
using protocol::Result;
using protocol::StepState;

void add_frame_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  dispatcher.add<methods::frame_step>([&host](const FrameStep& request,
                                              const protocol::CallContext& context,
                                              protocol::Completion<StepState> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    const Result<void> accepted = (*session)->timeline().request_step({.frames = request.frames,
                                                                       .dt = request.dt,
                                                                       .viewer = context.viewer,
                                                                       .answer = context.answer,
                                                                       .done = done});
    if (!accepted) done(accepted.error());
  });
  add_command<methods::frame_run>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string& viewer) -> Result<StepState> {
        return session.timeline().leave_lockstep(viewer);
      });
  add_command<methods::reference_start>(
      dispatcher, host,
      [](Session& session, const ReferenceStart& request, const std::string& viewer) {
        return session.reference().start(request, viewer);
      });
  add_command<methods::reference_stop>(
      dispatcher, host, [](Session& session, const Empty&, const std::string& viewer) {
        return session.reference().stop(viewer);
      });
  add_command<methods::reference_status>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) -> Result<ReferenceState> {
        return session.reference().state();
      });
}

}  // namespace heliograph::session
