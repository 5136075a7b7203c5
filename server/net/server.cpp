#include "net/server.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "net/connection.hpp"
#include "net/listener.hpp"
#include "net/websocket/reader_progress.hpp"
#include "session/event_log.hpp"

namespace heliograph::net {

using asio::ip::tcp;
using boost::system::error_code;

namespace {

// Those who measure are few, and must not be kept out by the many at the other door.
constexpr std::size_t most_measuring = 32;

std::vector<AddressRange> address_ranges(const std::vector<std::string>& texts) {
  return {texts.begin(), texts.end()};
}

std::unique_ptr<TlsCertificate> certificate(const ServerOptions& options) {
  if (options.tls_certificate.empty()) return nullptr;
  return std::make_unique<TlsCertificate>(
      TlsFiles{.certificate = options.tls_certificate, .key = options.tls_key});
}

}  // namespace

struct Server::State {
  State(session::SessionHost& host, const ServerOptions& settings, session::UploadStore* uploads)
      : options(settings),
        access(options.access),
        router(host, access, traffic, options.router),
        limits(options.max_connections, options.max_connections_per_client,
               address_ranges(options.access.trusted_proxies)),
        measuring_limits(most_measuring, most_measuring, {}),
        context{.host = host,
                .access = access,
                .router = router,
                .traffic = traffic,
                .uploads = uploads,
                .certificate = certificate(options),
                .on_last_left = [this] { io.stop(); },
                .connections = {}},
        door(io, options.access.bind_address, options.port,
             [this](tcp::socket socket) { welcome(std::move(socket), limits, Door::main); }) {
    if (options.measuring) {
      measuring_door.emplace(io, options.measuring->address, options.measuring->port,
                             [this](tcp::socket socket) {
                               welcome(std::move(socket), measuring_limits, Door::measuring);
                             });
    }
    stop_signals.add(SIGINT);
    stop_signals.add(SIGTERM);
    if (context.certificate) reload_signal.add(SIGHUP);
  }

  void welcome(tcp::socket socket, ConnectionLimits& room, Door by) {
    error_code gone;
    const tcp::endpoint peer = socket.remote_endpoint(gone);
    if (gone) return;
    auto slot = room.take(peer.address().to_string());
    if (!slot) {
      ++traffic.connections_refused;
      // One line for each would let who floods fill the disk too.
      if (refusals.allow(RateLimit::Clock::now())) {
        session::log_warning({.client = peer.address().to_string()},
                             fmt::format("a connection was refused: {} are open", room.open()));
      }
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    // Small, so that a finished write means the picture is nearly there.
    socket.set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent_bytes,
               sizeof unsent_bytes);
    notice_absence(socket.native_handle());
    start_http_connection(context, ClientStream(std::move(socket), *std::move(slot)), by);
  }

  void wait_for_signals() {
    stop_signals.async_wait([this](error_code error, int signal) {
      if (error) return;
      spdlog::info("shutting down after {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
      drain();
      stop_signals.async_wait([](error_code again, int) {
        if (!again) std::_Exit(EXIT_FAILURE);
      });
    });
    if (context.certificate) wait_for_reload();
  }

  void wait_for_reload() {
    reload_signal.async_wait([this](error_code error, int) {
      if (error) return;
      try {
        context.certificate->reload();
        spdlog::info("the certificate was read anew");
      } catch (const std::runtime_error& failure) {
        spdlog::error("the old certificate stays: {}", failure.what());
      }
      wait_for_reload();
    });
  }

  /// From now on nobody new is let in; after the notice, everybody is asked to leave.
  void drain() {
    if (std::exchange(context.draining, true)) return;
    router.drain();
    deadline.expires_after(options.drain_notice);
    deadline.async_wait([this](error_code) { end(); });
  }

  void end() {
    context.ending = true;
    door.close();
    if (measuring_door) measuring_door->close();
    if (context.connections.empty()) return io.stop();
    // Ending a connection takes it out of the set.
    const std::set<Connection*> open = context.connections;
    for (Connection* connection : open) connection->shut_down();
    deadline.expires_after(options.drain_deadline);
    deadline.async_wait([this](error_code) {
      spdlog::warn("{} connections did not end in time", context.connections.size());
      io.stop();
    });
  }

  const ServerOptions options;
  const AccessControl access;
  Traffic traffic;
  Router router;
  ConnectionLimits limits;
  ConnectionLimits measuring_limits;
  ServerContext context;  // outlives the connections that `io` still holds
  asio::io_context io{1};
  Listener door;
  std::optional<Listener> measuring_door;
  RateLimit refusals{1.0, 5.0, RateLimit::Clock::now()};
  asio::steady_timer deadline{io};
  asio::signal_set stop_signals{io};
  asio::signal_set reload_signal{io};
};

Server::Server(session::SessionHost& host, const ServerOptions& options,
               session::UploadStore* uploads)
    : state_(std::make_unique<State>(host, options, uploads)) {}

Server::~Server() = default;

std::string Server::url() const {
  return state_->door.url(state_->context.certificate ? "https" : "http");
}

std::optional<std::string> Server::metrics_url() const {
  if (!state_->measuring_door) return std::nullopt;
  return state_->measuring_door->url("http") + "metrics";
}

void Server::run() {
  state_->wait_for_signals();
  state_->door.accept();
  if (state_->measuring_door) state_->measuring_door->accept();
  state_->io.run();
}

void Server::stop() {
  asio::post(state_->io, [this] { state_->drain(); });
}

}  // namespace heliograph::net
