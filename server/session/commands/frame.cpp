#include "session/commands/commands.hpp"

// Frames on request: lockstep, and the path traced reference.

namespace heliograph::session {

using protocol::Empty;
using protocol::FrameStep;
using protocol::ReferenceStart;
using protocol::ReferenceState;
using protocol::Result;
using protocol::StepState;

void add_frame_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  dispatcher.add<FrameStep, StepState>(
      "frame.step", [&host](const FrameStep& request, const protocol::CallContext& context,
                            protocol::Completion<StepState> done) {
        const auto session = host.sessions().session_of(context);
        if (!session) return done(session.error());
        const Result<void> accepted = (*session)->timeline().request_step(
            {.frames = request.frames, .dt = request.dt, .viewer = context.viewer, .done = done});
        if (!accepted) done(accepted.error());
      });
  add_command<Empty, StepState>(
      dispatcher, host, "frame.run",
      [](Session& session, const Empty&, const std::string& viewer) -> Result<StepState> {
        return session.timeline().leave_lockstep(viewer);
      });
  add_command<ReferenceStart, ReferenceState>(
      dispatcher, host, "reference.start",
      [](Session& session, const ReferenceStart& request, const std::string& viewer) {
        return session.reference().start(request, viewer);
      });
  add_command<Empty, ReferenceState>(dispatcher, host, "reference.stop",
                                     [](Session& session, const Empty&, const std::string& viewer) {
                                       return session.reference().stop(viewer);
                                     });
  add_command<Empty, ReferenceState>(
      dispatcher, host, "reference.status",
      [](Session& session, const Empty&, const std::string&) -> Result<ReferenceState> {
        return session.reference().state();
      });
}

}  // namespace heliograph::session
