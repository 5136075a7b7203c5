#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <utility>

#include "net/client_stream.hpp"
#include "net/http/router.hpp"
#include "net/security/access_control.hpp"
#include "net/security/tls.hpp"
#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "session/library/upload_store.hpp"
#include "session/session_host.hpp"

// What the server and its connections share. For the sources of this folder only: it brings Boost.

namespace heliograph::net {

namespace asio = boost::asio;
namespace beast = boost::beast;

constexpr std::chrono::seconds handshake_timeout{10};
constexpr std::chrono::seconds idle_timeout{30};
constexpr std::chrono::seconds closing_timeout{2};
// Bytes a second; who takes less than that of a large answer is let go.
constexpr double slowest_reader = 8 * 1024;
// Of all connections together: answers that wait to be read. Small ones always find room.
constexpr std::size_t most_outgoing_bytes = 1u << 30;
constexpr std::size_t small_answer = 64u << 10;
constexpr std::size_t largest_request_head = 8 * 1024;
constexpr int send_buffer_bytes = 256 * 1024;
constexpr int unsent_bytes = 64 * 1024;
constexpr double calls_per_second = 500.0;
constexpr double calls_at_once = 1000.0;
// Who goes on after this many refusals is let go.
constexpr double refusals_per_second = 50.0;
constexpr double refusals_at_once = 1000.0;
constexpr double pings_per_second = 50.0;
constexpr double pings_at_once = 200.0;

/// What one connection holds of the memory of answers, given back at its end.
class OutgoingBytes {
 public:
  explicit OutgoingBytes(std::size_t& in_all) : in_all_(in_all) {}
  ~OutgoingBytes() { hold(0); }
  OutgoingBytes(const OutgoingBytes&) = delete;
  OutgoingBytes& operator=(const OutgoingBytes&) = delete;

  bool has_room(std::size_t more) const {
    return more <= small_answer || in_all_ + more <= most_outgoing_bytes;
  }
  void hold(std::size_t bytes) { in_all_ += bytes - std::exchange(held_, bytes); }

 private:
  std::size_t& in_all_;
  std::size_t held_ = 0;
};

/// Registers a connection for the end of the server.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Ends politely and soon.
  virtual void shut_down() = 0;
};

/// Where a connection came in: the port for everybody, or the one for measuring tools.
enum class Door { main, measuring };

/// One server's surroundings. All connections live on its one network thread.
struct ServerContext {
  session::SessionHost& host;
  const AccessControl& access;
  Router& router;
  Traffic& traffic;
  session::UploadStore* uploads;                // null: nothing can be uploaded
  std::unique_ptr<TlsCertificate> certificate;  // null: no TLS
  std::function<void()> on_last_left;           // called while ending, when nobody is left
  std::set<Connection*> connections;
  std::size_t outgoing_bytes = 0;  // see OutgoingBytes
  bool draining = false;           // nobody new is let in
  bool ending = false;             // everybody is asked to leave

  void enter(Connection& connection) {
    connections.insert(&connection);
    traffic.connections = connections.size();
  }
  void leave(Connection& connection) {
    connections.erase(&connection);
    traffic.connections = connections.size();
    if (ending && connections.empty()) on_last_left();
  }
};

/// Reads requests from a fresh connection and answers them, or hands it to a viewer.
void start_http_connection(ServerContext& context, ClientStream stream, Door door);

/// Answers a request that may be answered with a session's pictures without an end, as
/// multipart/x-mixed-replace. `headers` are those of every answer.
void start_picture_stream(ServerContext& context, ClientStream stream, const HttpRequest& request,
                          const std::string& session, const protocol::StreamConfigure& wishes);
/// How the query of such a request wants the pictures.
protocol::Result<protocol::StreamConfigure> picture_stream_wishes(const HttpRequest& request);

/// Carries on a connection whose client has asked for the viewers' WebSocket and may have it.
void start_viewer_connection(ServerContext& context, ClientStream stream,
                             const HttpRequest& request, Role role);

}  // namespace heliograph::net
