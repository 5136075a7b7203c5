#include "session/session_host.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "session/commands/commands.hpp"

namespace heliograph::session {

SessionHost::SessionHost(render::Engine& engine, HostOptions options)
    : engine_(engine),
      options_(std::move(options)),
      catalogue_(options_.scene_roots),
      render_loop_(engine),
      sessions_(
          options_.limits, options_.session,
          [this](SessionOptions session, PixelShare pixels) {
            return render_loop_.open(std::move(session), std::move(pixels));
          },
          [this](const Session& session) { render_loop_.close(session); }),
      dispatcher_(options_.dispatch),
      loader_(engine, catalogue_,
              {.environment = options_.environment,
               .limits = options_.import_limits,
               .cache_bytes = options_.scene_cache_bytes}),
      environments_(engine, catalogue_) {
  add_scene_commands(dispatcher_, *this);
  add_camera_commands(dispatcher_, *this);
  add_animation_commands(dispatcher_, *this);
  add_settings_commands(dispatcher_, *this);
  add_stream_commands(dispatcher_, *this);
  add_stats_commands(dispatcher_, *this);
  add_capture_commands(dispatcher_, *this);
  add_frame_commands(dispatcher_, *this);
  add_edit_commands(dispatcher_, *this);
  add_probe_commands(dispatcher_, *this);
  dispatcher_.set_gate([this](const protocol::MethodDescriptor&,
                              const protocol::CallContext& call) -> protocol::Result<void> {
    const auto session = sessions_.session_of(call);
    if (!session) return session.error();
    return {};
  });
  dispatcher_.on_handler_failure([](std::string_view method, std::string_view reason) {
    spdlog::error("{} failed: {}", method, reason);
  });
}

SessionHost::~SessionHost() {
  stop();
}

void SessionHost::stop() {
  loader_.stop();
  environments_.stop();
  render_loop_.stop();
}

void SessionHost::load_scene(std::shared_ptr<Session> session, const protocol::SceneLoad& request,
                             const std::string& by, SceneLoader::Completion done) {
  loader_.load(std::move(session), request, by, std::move(done));
}

void SessionHost::on_first_frame(std::function<void()> callback) {
  render_loop_.on_first_frame(std::move(callback));
}

}  // namespace heliograph::session
