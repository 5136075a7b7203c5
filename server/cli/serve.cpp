#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "cli/job_options.hpp"
#include "cli/log.hpp"
#include "cli/malloc_thresholds.hpp"
#include "cli/option_groups.hpp"
#include "cli/scene_roots.hpp"
#include "net/server.hpp"
#include "render/api/devices.hpp"
#include "session/session_host.hpp"

namespace heliograph::cli {
namespace {

session::HostOptions host_options(const ServeOptions& options) {
  session::HostOptions result;
  result.session.width = options.width.value_or(result.session.width);
  result.session.height = options.height.value_or(result.session.height);
  result.session.settings = parse_settings(options.settings);
  result.session.limits.max_viewers = options.max_viewers;
  result.release_after = std::chrono::seconds(options.release_after);
  result.annotators = protocol::enum_value<protocol::Annotators>(options.annotate).value();
  result.limits = {.sessions = options.max_sessions,
                   .viewers = options.max_all_viewers,
                   .pixels = options.max_pixels,
                   .idle_timeout = std::chrono::seconds(options.session_idle_timeout)};
  result.scene_roots = choose_scene_roots(options.scene_roots);
  if (!options.environment.empty()) result.environment = options.environment;
  result.import_limits = options.limits;
  result.scene_cache_bytes = options.scene_cache_bytes;
  const std::filesystem::path cache = cache_folder();
  if (!cache.empty()) result.thumbnail_folder = cache / "thumbnails";
  return result;
}

bool has_processor(const render::Engines& engines) {
  return std::ranges::any_of(engines, [](const render::Engine& engine) {
    return engine.device().type == protocol::DeviceType::cpu;
  });
}

/// The default frame size is smaller on a CPU than on a GPU.
void set_default_size(session::SessionOptions& session, const render::Engines& engines) {
  if (!has_processor(engines)) return;
  session.width = 640;
  session.height = 360;
}

std::vector<net::Token> tokens(const ServeOptions& options) {
  std::vector<net::Token> found;
  if (!options.token_file.empty()) found = net::read_token_file(options.token_file);
  if (!options.token.empty()) found.push_back({options.token, net::Role::control});
  if (!options.view_token.empty()) found.push_back({options.view_token, net::Role::view});
  return found;
}

/// "127.0.0.1:9464" or "[::1]:9464"
std::optional<net::Endpoint> endpoint(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t colon = std::min(text.rfind(':'), text.size());
  std::string address = text.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) {
    address = address.substr(1, address.size() - 2);
  }
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const char* const begin = text.data() + std::min(colon + 1, text.size());
  const auto parsed = std::from_chars(begin, end, port);
  if (address.empty() || parsed.ec != std::errc() || parsed.ptr != end) {
    throw std::invalid_argument("--metrics-listen " + text +
                                ": must be an address and a port, such as 127.0.0.1:9464");
  }
  return net::Endpoint{.address = address, .port = port};
}

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds));
}

net::ServerOptions server_options(const ServeOptions& options) {
  if (options.tls_certificate.empty() != options.tls_key.empty()) {
    throw std::invalid_argument("--tls-certificate and --tls-key must be specified together");
  }
  return {.port = options.port,
          .access = {.bind_address = options.host,
                     .tokens = tokens(options),
                     .insecure = options.insecure,
                     .allowed_origins = options.allowed_origins,
                     .allowed_hosts = options.allowed_hosts,
                     .trusted_proxies = options.trusted_proxies,
                     .embedded = !options.frame_ancestors.empty()},
          .router = {.frame_ancestors = options.frame_ancestors,
                     .metrics = options.metrics_listen.empty()},
          .tls_certificate = options.tls_certificate,
          .tls_key = options.tls_key,
          .metrics = endpoint(options.metrics_listen),
          .max_connections = options.max_connections,
          .max_connections_per_client = options.max_connections_per_client,
          .drain_notice = milliseconds(options.drain_notice),
          .drain_deadline = milliseconds(options.drain_deadline)};
}

std::unique_ptr<session::UploadStore> upload_store(const ServeOptions& options) {
  if (options.uploads.empty()) return nullptr;
  return std::make_unique<session::UploadStore>(session::UploadOptions{
      .folder = options.uploads,
      .max_bytes = options.max_upload_bytes,
      .quota = options.upload_quota,
      .import_arguments = import_arguments(options.limits, options.import_seconds)});
}

std::string how_to_bring_a_scene(const std::vector<std::filesystem::path>& roots, bool uploads) {
  std::string text = roots.empty() ? "start with --scene-root FOLDER"
                                   : "put .glb or .gltf files into " + roots.front().string();
  if (uploads) text += ", upload one with PUT /api/v1/scenes/NAME";
  return text + ", or make the demo scene with \"heliograph-scenes FOLDER\"";
}

/// Why the first scene could not be loaded. Written by the loading thread, read after it.
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

/// Stops the threads of the host while the receivers of its results still exist.
class HostStop {
 public:
  HostStop(session::SessionHost& host, session::UploadStore* uploads)
      : host_(host), uploads_(uploads) {}
  ~HostStop() {
    if (uploads_) uploads_->stop();
    host_.stop();
  }
  HostStop(const HostStop&) = delete;
  HostStop& operator=(const HostStop&) = delete;

 private:
  session::SessionHost& host_;
  session::UploadStore* uploads_;
};

}  // namespace

int run(const ServeOptions& options) {
  set_up_log(options.log);
  session::HostOptions hosting = host_options(options);
  const std::unique_ptr<session::UploadStore> uploads = upload_store(options);
  if (uploads) {
    hosting.scene_roots.push_back(uploads->scenes());
    hosting.environment_roots.push_back(uploads->environments());
    hosting.image_roots.push_back(uploads->images());
    hosting.upload_roots = {.scenes = uploads->scenes(),
                            .environments = uploads->environments(),
                            .images = uploads->images()};
    hosting.max_upload_bytes = uploads->max_bytes();
  }
  const std::optional<std::string> scene =
      choose_scene(session::SceneCatalogue(hosting.scene_roots), options.scene);
  hosting.session.starts_empty = !scene;
  net::ServerOptions serving = server_options(options);
  net::check_server_options(serving);

  const std::vector<std::unique_ptr<render::Engine>> made = make_engines(options.device);
  render::Engines engines;
  for (const auto& engine : made) {
    engines.push_back(*engine);
    spdlog::info("rendering on {} ({}), ray tracer {}", engine->device().name,
                 engine->device().driver, protocol::enum_name(engine->tracer()));
  }
  for (const render::Engine& engine : engines) set_malloc_thresholds(engine);
  if (!options.width && !options.height) set_default_size(hosting.session, engines);
  const std::unique_ptr<jobs::JobQueue> job_queue = make_job_queue(options, hosting);
  hosting.jobs = job_queue.get();
  session::SessionHost host(engines, hosting);
  if (uploads) {
    serving.router.uploads = uploads->scenes();
    serving.router.uploaded_environments = uploads->environments();
  }
  net::Server server(host, serving, uploads.get());

  host.on_first_frame([url = server.url(), metrics = server.metrics_url()] {
    std::printf("listening on %s\n", url.c_str());
    if (metrics) std::printf("metrics at %s\n", metrics->c_str());
    std::fflush(stdout);
  });
  StartFailure failure;
  const HostStop stop_first(host, uploads.get());
  if (scene) {
    host.load_scene(host.sessions().main(), {.name = *scene}, {},
                    [&](const protocol::Result<protocol::SceneInfo>& loaded) {
                      // Clients may load another scene before the first is loaded, or cancel it.
                      const auto conflict = protocol::ErrorCode::conflict;
                      if (loaded || loaded.error().code == conflict) return;
                      failure.set(*scene + ": " + loaded.error().reason);
                      server.stop();
                    });
  } else {
    spdlog::warn("no scene found: {}",
                 how_to_bring_a_scene(hosting.scene_roots, uploads != nullptr));
  }
  server.run();
  if (const auto reason = failure.get()) throw std::runtime_error(*reason);
  return 0;
}

}  // namespace heliograph::cli
