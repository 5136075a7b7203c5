#include <spdlog/spdlog.h>

#include <cstdio>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "cli/log.hpp"
#include "cli/scene_roots.hpp"
#include "net/server.hpp"
#include "session/session_host.hpp"

namespace heliograph::cli {
namespace {

session::HostOptions host_options(const ServeOptions& options) {
  session::HostOptions result;
  result.session.width = options.width.value_or(result.session.width);
  result.session.height = options.height.value_or(result.session.height);
  result.session.settings = parse_settings(options.settings);
  result.session.limits.max_viewers = options.max_viewers;
  result.limits.viewers = options.max_viewers;
  result.scene_roots = choose_scene_roots(options.scene_roots);
  if (!options.environment.empty()) result.environment = options.environment;
  result.import_limits = options.limits;
  return result;
}

/// Where nobody says how large pictures are to be, a processor is not given the work of a GPU.
void fit_size(session::SessionOptions& session, const render::DeviceInfo& device) {
  if (device.type != protocol::DeviceType::cpu) return;
  session.width = 640;
  session.height = 360;
}

net::ServerOptions server_options(const ServeOptions& options) {
  return {.port = options.port,
          .access = {.bind_address = options.host,
                     .token = options.token,
                     .insecure = options.insecure,
                     .allowed_origins = options.allowed_origins}};
}

/// Why the first scene could not be shown. Written by the loading thread, read after it.
class StartFailure {
 public:
  void set(std::string reason) {
    const std::lock_guard lock(mutex_);
    reason_ = std::move(reason);
  }
  std::optional<std::string> get() const {
    const std::lock_guard lock(mutex_);
    return reason_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<std::string> reason_;
};

/// Ends the threads of the host while those who get its answers still exist.
class HostStop {
 public:
  explicit HostStop(session::SessionHost& host) : host_(host) {}
  ~HostStop() { host_.stop(); }
  HostStop(const HostStop&) = delete;
  HostStop& operator=(const HostStop&) = delete;

 private:
  session::SessionHost& host_;
};

}  // namespace

int run(const ServeOptions& options) {
  set_up_log(options.log);
  session::HostOptions hosting = host_options(options);
  const std::string scene =
      choose_scene(session::SceneCatalogue(hosting.scene_roots), options.scene);

  render::Engine engine(engine_options(options.device));
  spdlog::info("rendering on {} ({}), rays by {}", engine.device().name, engine.device().driver,
               protocol::enum_name(engine.tracer()));
  if (!options.width && !options.height) fit_size(hosting.session, engine.device());
  session::SessionHost host(engine, hosting);
  net::Server server(host, server_options(options));

  host.on_first_frame([url = server.url()] {
    std::printf("listening on %s\n", url.c_str());
    std::fflush(stdout);
  });
  StartFailure failure;
  const HostStop stop_first(host);
  host.load_scene(host.sessions().main(), scene, {}, [&](const protocol::Result<protocol::SceneInfo>& loaded) {
    if (loaded) return;
    failure.set(scene + ": " + loaded.error().message);
    server.stop();
  });
  server.run();
  if (const auto reason = failure.get()) throw std::runtime_error(*reason);
  return 0;
}

}  // namespace heliograph::cli
