#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <set>

#include "net/access_control.hpp"
#include "net/router.hpp"
#include "session/session_host.hpp"

// What the server and its connections share. For the sources of this folder only: it brings Boost.

namespace heliograph::net {

namespace asio = boost::asio;
namespace beast = boost::beast;

constexpr std::chrono::seconds handshake_timeout{10};
constexpr std::chrono::seconds idle_timeout{30};
constexpr std::chrono::seconds drain_deadline{2};
constexpr std::size_t most_connections = 256;
constexpr std::size_t largest_request_head = 8 * 1024;
constexpr int send_buffer_bytes = 256 * 1024;
constexpr double calls_per_second = 500.0;
constexpr double calls_at_once = 1000.0;

/// Registers a connection for the end of the server.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Ends politely and soon.
  virtual void shut_down() = 0;
};

/// One server's surroundings. All connections live on its one network thread.
struct ServerContext {
  session::SessionHost& host;
  const AccessControl& access;
  Router& router;
  asio::io_context& io;
  std::set<Connection*> connections;
  bool draining = false;

  void enter(Connection& connection) { connections.insert(&connection); }
  void leave(Connection& connection) {
    connections.erase(&connection);
    if (draining && connections.empty()) io.stop();
  }
};

/// Reads requests from a fresh connection and answers them, or hands it to a viewer.
void start_http_connection(ServerContext& context, asio::ip::tcp::socket socket);

/// Carries on a connection whose client has asked for the viewers' WebSocket and may have it.
void start_viewer_connection(ServerContext& context, beast::tcp_stream stream,
                             const HttpRequest& request);

}  // namespace heliograph::net
