#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <thread>
#include <utility>

#include "net/client_stream.hpp"
#include "net/http/router.hpp"
#include "net/security/access_control.hpp"
#include "net/security/tls.hpp"
#include "protocol/json/pending_answer.hpp"
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
// A client that reads a large response more slowly is disconnected.
constexpr double min_bytes_per_second = 8 * 1024;
// Unread responses of all connections together. Small ones are always accepted.
constexpr std::size_t max_outgoing_bytes = 1u << 30;
constexpr std::size_t small_answer = 64u << 10;
constexpr std::size_t max_request_head_bytes = 8 * 1024;
constexpr int send_buffer_bytes = 256 * 1024;
constexpr int unsent_bytes = 64 * 1024;
constexpr double calls_per_second = 500.0;
constexpr double calls_at_once = 1000.0;
// A client that exceeds this rate of rejected calls is disconnected.
constexpr double rejections_per_second = 50.0;
constexpr double rejections_at_once = 1000.0;
constexpr double pings_per_second = 50.0;
constexpr double pings_at_once = 200.0;

/// One connection's part of the memory of unread responses, released when it ends.
class OutgoingBytes {
 public:
  explicit OutgoingBytes(std::size_t& in_all) : in_all_(in_all) {}
  ~OutgoingBytes() { hold(0); }
  OutgoingBytes(const OutgoingBytes&) = delete;
  OutgoingBytes& operator=(const OutgoingBytes&) = delete;

  bool has_room(std::size_t more) const {
    return more <= small_answer || in_all_ + more <= max_outgoing_bytes;
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
  /// Closes in order, within closing_timeout.
  virtual void shut_down() = 0;
};

/// The port that a connection was accepted on: the main one, or the one for metrics and health.
enum class ListenerKind { main, metrics };

/// What all connections of a server share. Used on its one network thread only.
struct ServerContext {
  session::SessionHost& host;
  const AccessControl& access;
  Router& router;
  Traffic& traffic;
  session::UploadStore* uploads;                // null: uploads are disabled
  std::unique_ptr<TlsCertificate> certificate;  // null: no TLS
  std::function<void()> on_last_closed;         // called while ending, when no connection is open
  std::set<Connection*> connections;
  std::size_t outgoing_bytes = 0;  // see OutgoingBytes
  // Of responses that are not made yet, beside those.
  const std::shared_ptr<protocol::AnswerMemory> answer_memory =
      std::make_shared<protocol::AnswerMemory>(max_outgoing_bytes);
  const std::thread::id thread = std::this_thread::get_id();
  bool draining = false;  // no new viewers are accepted
  bool ending = false;    // all connections are being closed

  void enter(Connection& connection) {
    connections.insert(&connection);
    traffic.connections = connections.size();
  }
  void leave(Connection& connection) {
    connections.erase(&connection);
    traffic.connections = connections.size();
    if (ending && connections.empty()) on_last_closed();
  }
};

/// A connection that ends on the network thread, whichever thread releases it last, such as the one
/// that made its answer: its end changes what all connections share.
template <class Made, class... Arguments>
std::shared_ptr<Made> make_connection(ServerContext& context, ClientStream stream,
                                      Arguments&&... arguments) {
  const auto end = [thread = context.thread,
                    executor = stream.get_executor()](Connection* connection) {
    std::shared_ptr<Connection> own(connection);
    if (std::this_thread::get_id() != thread) run_later(executor, [own = std::move(own)] {});
  };
  return {new Made(context, std::move(stream), std::forward<Arguments>(arguments)...), end};
}

/// Reads requests from a new connection and responds to them, or upgrades it to a viewer's.
void start_http_connection(ServerContext& context, ClientStream stream, ListenerKind kind);

/// Responds with an endless stream of a session's frames, as multipart/x-mixed-replace. The request
/// was admitted.
void start_mjpeg_stream(ServerContext& context, ClientStream stream, const HttpRequest& request,
                        const std::string& session, const protocol::StreamConfigure& options);
/// The quality and frame rate that the query of such a request asks for.
protocol::Result<protocol::StreamConfigure> mjpeg_stream_options(const HttpRequest& request);

/// Upgrades a connection whose client was admitted to the viewers' WebSocket.
void start_viewer_connection(ServerContext& context, ClientStream stream,
                             const HttpRequest& request, Role role);

}  // namespace heliograph::net
