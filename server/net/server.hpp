#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "net/access_control.hpp"
#include "session/session_host.hpp"

namespace heliograph::net {

struct ServerOptions {
  std::uint16_t port = 8080;  // 0: any free one
  AccessOptions access;
};

/// Listens for HTTP and WebSocket clients and serves them on the thread that calls `run`.
class Server {
 public:
  /// Opens the port. @throws std::runtime_error, std::invalid_argument
  Server(session::SessionHost& host, const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "http://127.0.0.1:8080/"
  std::string url() const;
  /// Serves until `stop`, SIGINT or SIGTERM; then tells every viewer to come back later. A second
  /// signal ends the process at once.
  void run();
  /// Ends `run` soon. Any thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::net
