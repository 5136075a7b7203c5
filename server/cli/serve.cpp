#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
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
  result.release_after = std::chrono::seconds(options.release_after);
  result.limits = {.sessions = options.max_sessions,
                   .viewers = options.max_all_viewers,
                   .pixels = options.max_pixels,
                   .idle_timeout = std::chrono::seconds(options.session_idle_timeout)};
  result.scene_roots = choose_scene_roots(options.scene_roots);
  if (!options.environment.empty()) result.environment = options.environment;
  result.import_limits = options.limits;
  result.scene_cache_bytes = options.scene_cache_bytes;
  return result;
}

/// Where nobody says how large pictures are to be, a processor is not given the work of a GPU.
void fit_size(session::SessionOptions& session, const render::DeviceInfo& device) {
  if (device.type != protocol::DeviceType::cpu) return;
  session.width = 640;
  session.height = 360;
}

/// A processor's images are pieces of this process's memory. Left alone, the C library takes ever
/// larger ones from the arenas that small pieces come from, up to 32 MB, and keeps what is freed
/// among them. Mapped for themselves they go back to the system at once: after a dozen sessions
/// have come and gone the process takes 240 MB that way and 460 without. What is free at an arena's
/// end is kept up to a size, or every frame would pay for its working memory anew. With a GPU only
/// pictures on their way would be mapped, 2 to 3 ms for each of 1920x1080.
void map_images_for_themselves(const render::DeviceInfo& device) {
  if (device.type != protocol::DeviceType::cpu) return;
#ifdef __GLIBC__
  constexpr int own_mapping_bytes = 1 << 20;
  constexpr int kept_free_bytes = 16 << 20;
  mallopt(M_MMAP_THRESHOLD, own_mapping_bytes);
  mallopt(M_TRIM_THRESHOLD, kept_free_bytes);
#endif
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
                                ": must be an address and a port such as 127.0.0.1:9464");
  }
  return net::Endpoint{.address = address, .port = port};
}

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds));
}

net::ServerOptions server_options(const ServeOptions& options) {
  if (options.tls_certificate.empty() != options.tls_key.empty()) {
    throw std::invalid_argument("--tls-certificate and --tls-key go together");
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
          .measuring = endpoint(options.metrics_listen),
          .max_connections = options.max_connections,
          .max_connections_per_client = options.max_connections_per_client,
          .drain_notice = milliseconds(options.drain_notice),
          .drain_deadline = milliseconds(options.drain_deadline)};
}

std::unique_ptr<session::UploadStore> upload_store(const ServeOptions& options) {
  if (options.uploads.empty()) return nullptr;
  return std::make_unique<session::UploadStore>(
      session::UploadOptions{.folder = options.uploads,
                             .max_bytes = options.max_upload_bytes,
                             .quota = options.upload_quota,
                             .import_limits = options.limits});
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
    hosting.max_upload_bytes = uploads->max_bytes();
  }
  const std::string scene =
      choose_scene(session::SceneCatalogue(hosting.scene_roots), options.scene);

  render::Engine engine(engine_options(options.device));
  spdlog::info("rendering on {} ({}), rays by {}", engine.device().name, engine.device().driver,
               protocol::enum_name(engine.tracer()));
  map_images_for_themselves(engine.device());
  if (!options.width && !options.height) fit_size(hosting.session, engine.device());
  session::SessionHost host(engine, hosting);
  net::ServerOptions serving = server_options(options);
  if (uploads) serving.router.uploads = uploads->scenes();
  net::Server server(host, serving, uploads.get());

  host.on_first_frame([url = server.url(), metrics = server.metrics_url()] {
    std::printf("listening on %s\n", url.c_str());
    if (metrics) std::printf("metrics at %s\n", metrics->c_str());
    std::fflush(stdout);
  });
  StartFailure failure;
  const HostStop stop_first(host, uploads.get());
  host.load_scene(host.sessions().main(), {.name = scene}, {},
                  [&](const protocol::Result<protocol::SceneInfo>& loaded) {
                    // Clients may ask for another scene before the first is there, or cancel it.
                    const auto conflict = protocol::ErrorCode::conflict;
                    if (loaded || loaded.error().code == conflict) return;
                    failure.set(scene + ": " + loaded.error().message);
                    server.stop();
                  });
  server.run();
  if (const auto reason = failure.get()) throw std::runtime_error(*reason);
  return 0;
}

}  // namespace heliograph::cli
