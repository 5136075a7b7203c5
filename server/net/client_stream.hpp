#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream_base.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "net/io_handler.hpp"
#include "net/security/connection_limits.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// A sequence of at most `capacity` buffers, which is what an operation may read or write at once;
/// what is beyond is left to the next one.
template <class Buffer>
class BufferList {
 public:
  using value_type = Buffer;
  using const_iterator = const Buffer*;

  template <class Buffers>
  explicit BufferList(const Buffers& buffers) {
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto next = boost::asio::buffer_sequence_begin(buffers); next != end; ++next) {
      if (size_ == capacity) break;
      buffers_[size_++] = *next;
    }
  }
  const_iterator begin() const { return buffers_.data(); }
  const_iterator end() const { return buffers_.data() + size_; }

 private:
  static constexpr std::size_t capacity = 16;
  std::array<Buffer, capacity> buffers_;
  std::size_t size_ = 0;
};

using ReadBuffers = BufferList<boost::asio::mutable_buffer>;
using WriteBuffers = BufferList<boost::asio::const_buffer>;

/// A connection, plain or inside TLS: one type of stream for HTTP and WebSocket alike. The
/// operations of TCP and TLS are compiled in client_stream.cpp, with IoHandler as their handler.
class ClientStream {
 public:
  using Plain = boost::beast::tcp_stream;
  using executor_type = Plain::executor_type;

  /// Holds `slot` for as long as the stream exists.
  ClientStream(boost::asio::ip::tcp::socket socket, ConnectionLimits::Slot slot);
  ClientStream(ClientStream&&) noexcept;
  ~ClientStream();

  bool is_secure() const;
  /// False once it was moved from.
  bool has_socket() const { return layers_ != nullptr; }
  /// The address of the other end, which may be a proxy.
  const std::string& peer() const { return slot_.address(); }
  /// TCP below, with its timeouts.
  Plain& next_layer();
  const Plain& next_layer() const { return const_cast<ClientStream*>(this)->next_layer(); }
  executor_type get_executor() { return next_layer().get_executor(); }

  /// Begins TLS; `received` are the first bytes of it that were read already. The handler gets how
  /// many of them were used.
  void async_secure(std::shared_ptr<boost::asio::ssl::context> context,
                    boost::asio::ssl::stream_base::handshake_type role,
                    boost::asio::const_buffer received, IoHandler handler);

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    read_some(ReadBuffers(buffers), IoHandler(std::forward<Handler>(handler)));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    write_some(WriteBuffers(buffers), IoHandler(std::forward<Handler>(handler)));
  }

  /// Ends TLS and TCP in order; Beast's WebSocket calls it at its end.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ClientStream& stream,
                             Handler&& handler) {
    stream.tear_down(role, IoHandler(std::forward<Handler>(handler)));
  }

 private:
  struct Layers;

  void read_some(const ReadBuffers& buffers, IoHandler handler);
  void write_some(const WriteBuffers& buffers, IoHandler handler);
  void tear_down(boost::beast::role_type role, IoHandler handler);

  std::unique_ptr<Layers> layers_;
  ConnectionLimits::Slot slot_;
};

/// Writes all of `buffers`, whose bytes live until then.
void write_all(ClientStream& stream, const WriteBuffers& buffers, IoHandler handler);

/// Tells whether the client begins with TLS; what was read for that is in `buffer`.
void detect_tls(ClientStream& stream, boost::beast::flat_buffer& buffer,
                std::function<void(boost::system::error_code, bool)> handler);

/// Calls `work` on the network thread, later.
void run_later(const ClientStream::executor_type& executor, std::function<void()> work);

/// Calls `work` when the timer expires or is cancelled.
void on_expiry(boost::asio::steady_timer& timer,
               std::function<void(boost::system::error_code)> work);

}  // namespace heliograph::net
