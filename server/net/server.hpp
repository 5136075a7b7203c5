#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "net/http/router.hpp"
#include "net/security/access_control.hpp"
#include "session/library/upload_store.hpp"
#include "session/session_host.hpp"

namespace heliograph::net {

struct Endpoint {
  std::string address;
  std::uint16_t port = 0;  // 0: any free port
};

struct ServerOptions {
  std::uint16_t port = 8080;  // 0: any free port
  AccessOptions access;
  RouterOptions router;
  std::filesystem::path tls_certificate;  // PEM; empty: plain HTTP
  std::filesystem::path tls_key;
  std::optional<Endpoint> metrics;  // another port, for metrics and health only
  std::size_t max_connections = 256;
  std::size_t max_connections_per_client = 64;
  /// How long the server reports that it is not ready before it closes connections, so that load
  /// balancers notice first.
  std::chrono::milliseconds drain_notice{0};
  /// How long responses in progress and closing handshakes may take after that.
  std::chrono::milliseconds drain_deadline{5000};
};

/// Whether a server could start with these options now: certificates, tokens, origins and ports.
/// @throws std::runtime_error, std::invalid_argument
void check_server_options(const ServerOptions& options);

/// Listens for HTTP and WebSocket clients and serves them on the thread that calls `run`.
class Server {
 public:
  /// Opens the ports. @throws std::runtime_error, std::invalid_argument
  Server(session::SessionHost& host, const ServerOptions& options,
         session::UploadStore* uploads = nullptr);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "http://127.0.0.1:8080/"
  std::string url() const;
  /// URL of the metrics if they have a port of their own: "http://127.0.0.1:9464/metrics"
  std::optional<std::string> metrics_url() const;
  /// Serves until `stop`, SIGINT or SIGTERM; then rejects new viewers and tells connected ones to
  /// reconnect later. A second signal ends the process at once. SIGHUP reloads the certificate.
  void run();
  /// Ends `run` soon. Any thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::net
