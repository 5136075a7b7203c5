#include "net/server.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>

#include "net/connection.hpp"
#include "net/listener.hpp"
#include "net/tcp_progress.hpp"
#include "session/event_log.hpp"

namespace heliograph::net {

using asio::ip::tcp;
using boost::system::error_code;

namespace {

// Apart from the main port's limit, so that viewers cannot keep monitoring out.
constexpr std::size_t max_metrics_connections = 32;
constexpr std::chrono::milliseconds pause_after_failure{10};

std::vector<AddressRange> address_ranges(const std::vector<std::string>& texts) {
  return {texts.begin(), texts.end()};
}

std::unique_ptr<TlsCertificate> certificate(const ServerOptions& options) {
  if (options.tls_certificate.empty()) return nullptr;
  return std::make_unique<TlsCertificate>(
      TlsFiles{.certificate = options.tls_certificate, .key = options.tls_key});
}

}  // namespace

void check_server_options(const ServerOptions& options) {
  const AccessControl access(options.access);
  certificate(options);
  asio::io_context io;
  const Listener main(io, options.access.bind_address, options.port, {});
  if (options.metrics) Listener(io, options.metrics->address, options.metrics->port, {});
}

struct Server::State {
  State(session::SessionHost& host, const ServerOptions& settings, session::UploadStore* uploads)
      : options(settings),
        access(options.access),
        router(host, access, traffic, options.router),
        limits(options.max_connections, options.max_connections_per_client,
               address_ranges(options.access.trusted_proxies)),
        metrics_limits(max_metrics_connections, max_metrics_connections, {}),
        context{.host = host,
                .access = access,
                .router = router,
                .traffic = traffic,
                .uploads = uploads,
                .certificate = certificate(options),
                .on_last_closed = [this] { io.stop(); },
                .connections = {}},
        listener(io, options.access.bind_address, options.port, [this](tcp::socket socket) {
          accept_client(std::move(socket), limits, ListenerKind::main);
        }) {
    if (options.metrics) {
      metrics_listener.emplace(
          io, options.metrics->address, options.metrics->port, [this](tcp::socket socket) {
            accept_client(std::move(socket), metrics_limits, ListenerKind::metrics);
          });
    }
    stop_signals.add(SIGINT);
    stop_signals.add(SIGTERM);
    if (context.certificate) reload_signal.add(SIGHUP);
  }

  void accept_client(tcp::socket socket, ConnectionLimits& limits_of_listener, ListenerKind kind) {
    error_code gone;
    const tcp::endpoint peer = socket.remote_endpoint(gone);
    if (gone) return;
    auto slot = limits_of_listener.take(peer.address().to_string());
    if (!slot) {
      ++traffic.connections_refused;
      // A line for each would let a flood of connections fill the disk.
      if (refusals.allow(RateLimit::Clock::now())) {
        session::log_warning(
            {.client = peer.address().to_string()},
            fmt::format("connection rejected: {} are open", limits_of_listener.open()));
      }
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    // Small, so that a completed write means that most of the frame has arrived.
    socket.set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent_bytes,
               sizeof unsent_bytes);
    enable_keepalive(socket.native_handle());
    start_http_connection(context, ClientStream(std::move(socket), *std::move(slot)), kind);
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
        spdlog::info("the certificate was reloaded");
      } catch (const std::runtime_error& failure) {
        spdlog::error("the certificate was not reloaded, the old one stays in use: {}",
                      failure.what());
      }
      wait_for_reload();
    });
  }

  /// False if a handler failed, as where memory is exhausted: it has cost its connection, no more.
  bool run_handlers() {
    try {
      listener.accept();
      if (metrics_listener) metrics_listener->accept();
      io.run();
      return true;
    } catch (const std::exception& failure) {
      spdlog::error("a connection failed: {}", failure.what());
    }
    std::this_thread::sleep_for(pause_after_failure);
    return false;
  }

  /// Stops accepting viewers; after the drain notice, closes all connections.
  void drain() {
    if (std::exchange(context.draining, true)) return;
    router.drain();
    deadline.expires_after(options.drain_notice);
    deadline.async_wait([this](error_code) { end(); });
  }

  void end() {
    context.ending = true;
    listener.close();
    if (metrics_listener) metrics_listener->close();
    if (context.connections.empty()) return io.stop();
    // Closing a connection removes it from the set.
    const std::set<Connection*> open = context.connections;
    for (Connection* connection : open) connection->shut_down();
    deadline.expires_after(options.drain_deadline);
    deadline.async_wait([this](error_code) {
      spdlog::warn("{} connections were not closed within the drain deadline",
                   context.connections.size());
      io.stop();
    });
  }

  const ServerOptions options;
  const AccessControl access;
  Traffic traffic;
  Router router;
  ConnectionLimits limits;
  ConnectionLimits metrics_limits;
  ServerContext context;  // outlives the connections that `io` still holds
  asio::io_context io{1};
  Listener listener;
  std::optional<Listener> metrics_listener;
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
  return state_->listener.url(state_->context.certificate ? "https" : "http");
}

std::optional<std::string> Server::metrics_url() const {
  if (!state_->metrics_listener) return std::nullopt;
  return state_->metrics_listener->url("http") + "metrics";
}

void Server::run() {
  state_->wait_for_signals();
  while (!state_->run_handlers()) continue;
}

void Server::stop() {
  asio::post(state_->io, [this] { state_->drain(); });
}

}  // namespace heliograph::net
