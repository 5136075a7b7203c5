#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <memory>
#include <utility>
#include <variant>

#include "net/security/connection_limits.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// A client's connection, plain or inside TLS: one type of stream for HTTP and WebSocket alike.
class ClientStream {
 public:
  using Plain = boost::beast::tcp_stream;
  using Secure = boost::beast::ssl_stream<Plain>;
  using executor_type = Plain::executor_type;

  /// Keeps `seat` until its own end.
  ClientStream(boost::asio::ip::tcp::socket socket, ConnectionLimits::Seat seat)
      : stream_(std::in_place_type<Plain>, std::move(socket)), seat_(std::move(seat)) {}

  bool is_secure() const { return std::holds_alternative<Secure>(stream_); }
  /// The address of the other end, which may be a proxy.
  const std::string& peer() const { return seat_.address(); }
  /// TCP below, with its timeouts.
  Plain& next_layer() {
    if (Secure* secure = std::get_if<Secure>(&stream_)) return secure->next_layer();
    return std::get<Plain>(stream_);
  }
  const Plain& next_layer() const { return const_cast<ClientStream*>(this)->next_layer(); }
  executor_type get_executor() { return next_layer().get_executor(); }

  /// Begins TLS; `received` are the first bytes of it that were read already.
  template <class Buffers, class Handler>
  void async_secure(std::shared_ptr<boost::asio::ssl::context> context, const Buffers& received,
                    Handler&& handler) {
    Plain plain = std::get<Plain>(std::move(stream_));
    Secure& secure = stream_.emplace<Secure>(std::move(plain), *context);
    context_ = std::move(context);
    secure.async_handshake(boost::asio::ssl::stream_base::server, received,
                           std::forward<Handler>(handler));
  }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    std::visit(
        [&](auto& stream) { stream.async_read_some(buffers, std::forward<Handler>(handler)); },
        stream_);
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    std::visit(
        [&](auto& stream) { stream.async_write_some(buffers, std::forward<Handler>(handler)); },
        stream_);
  }

  /// Ends politely what was said; Beast's WebSocket calls it at its end.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ClientStream& stream,
                             Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    std::visit([&](auto& kind) { async_teardown(role, kind, std::forward<Handler>(handler)); },
               stream.stream_);
  }

 private:
  std::shared_ptr<boost::asio::ssl::context> context_;  // outlives the stream made with it
  std::variant<Plain, Secure> stream_;
  ConnectionLimits::Seat seat_;
};

}  // namespace heliograph::net
