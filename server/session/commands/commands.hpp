#pragma once

#include "protocol/json/jsonrpc.hpp"
#include "session/session_host.hpp"

// The methods of the protocol, one file per group. Shapes and ranges of parameters are checked
// before a command is called.

namespace heliograph::session {

void add_session_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_scene_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_camera_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_bookmark_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_animation_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_settings_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_stream_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_stats_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_capture_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_frame_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_edit_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_texture_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_node_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_probe_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_section_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_measurement_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_annotation_commands(protocol::Dispatcher& dispatcher, SessionHost& host);
void add_job_commands(protocol::Dispatcher& dispatcher, SessionHost& host);

/// Adds a command that answers at once: `command(session, request, viewer)` gives a
/// Result<Response>. The session is the one that the call is for.
template <class Method, class Command>
void add_command(protocol::Dispatcher& dispatcher, SessionHost& host, Command command) {
  dispatcher.add<Method>(
      [&host, command = std::move(command)](const typename Method::Params& request,
                                            const protocol::CallContext& context,
                                            protocol::Completion<typename Method::Result> done) {
        const auto session = host.sessions().session_of(context);
        if (!session) return done(session.error());
        done(command(**session, request, context.viewer));
      });
}

}  // namespace heliograph::session
