#include "net/client_stream.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/detect_ssl.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <variant>

namespace heliograph::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;

struct ClientStream::Layers {
  using Secure = beast::ssl_stream<Plain>;

  explicit Layers(asio::ip::tcp::socket socket)
      : stream(std::in_place_type<Plain>, std::move(socket)) {}

  std::shared_ptr<asio::ssl::context> context;  // outlives the stream made with it
  std::variant<Plain, Secure> stream;
};

ClientStream::ClientStream(asio::ip::tcp::socket socket, ConnectionLimits::Slot slot)
    : layers_(std::make_unique<Layers>(std::move(socket))), slot_(std::move(slot)) {}

ClientStream::ClientStream(ClientStream&&) noexcept = default;
ClientStream::~ClientStream() = default;

bool ClientStream::is_secure() const {
  return std::holds_alternative<Layers::Secure>(layers_->stream);
}

ClientStream::Plain& ClientStream::next_layer() {
  if (auto* secure = std::get_if<Layers::Secure>(&layers_->stream)) return secure->next_layer();
  return std::get<Plain>(layers_->stream);
}

void ClientStream::async_secure(std::shared_ptr<asio::ssl::context> context,
                                asio::ssl::stream_base::handshake_type role,
                                asio::const_buffer received, IoHandler handler) {
  Plain plain = std::get<Plain>(std::move(layers_->stream));
  auto& secure = layers_->stream.emplace<Layers::Secure>(std::move(plain), *context);
  layers_->context = std::move(context);
  secure.async_handshake(role, received, std::move(handler));
}

void ClientStream::read_some(const ReadBuffers& buffers, IoHandler handler) {
  std::visit([&](auto& stream) { stream.async_read_some(buffers, std::move(handler)); },
             layers_->stream);
}

void ClientStream::write_some(const WriteBuffers& buffers, IoHandler handler) {
  std::visit([&](auto& stream) { stream.async_write_some(buffers, std::move(handler)); },
             layers_->stream);
}

void ClientStream::tear_down(beast::role_type role, IoHandler handler) {
  using beast::websocket::async_teardown;
  std::visit([&](auto& stream) { async_teardown(role, stream, std::move(handler)); },
             layers_->stream);
}

void write_all(ClientStream& stream, const WriteBuffers& buffers, IoHandler handler) {
  asio::async_write(stream, buffers, std::move(handler));
}

void detect_tls(ClientStream& stream, beast::flat_buffer& buffer,
                std::function<void(error_code, bool)> handler) {
  beast::async_detect_ssl(stream.next_layer(), buffer, std::move(handler));
}

void run_later(const ClientStream::executor_type& executor, std::function<void()> work) {
  asio::post(executor, std::move(work));
}

void on_expiry(asio::steady_timer& timer, std::function<void(error_code)> work) {
  timer.async_wait(std::move(work));
}

}  // namespace heliograph::net
