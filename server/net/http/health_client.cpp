#include "net/http/health_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <optional>
#include <string_view>
#include <type_traits>

#include "net/security/access_control.hpp"

namespace heliograph::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

struct Address {
  std::string host;
  std::string port;
  std::string target;
  bool secure = false;
};

std::optional<Address> parse_url(std::string_view url) {
  const bool secure = url.starts_with("https://");
  if (!secure && !url.starts_with("http://")) return std::nullopt;
  url.remove_prefix(url.find("//") + 2);
  const std::size_t slash = std::min(url.find('/'), url.size());
  std::string_view authority = url.substr(0, slash);
  Address address{.host = {},
                  .port = secure ? "443" : "80",
                  .target = std::string(url.substr(slash)),
                  .secure = secure};
  if (address.target.empty()) address.target = "/";
  const std::size_t colon = authority.rfind(':');
  const std::size_t bracket = authority.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  if (has_port) {
    address.port = authority.substr(colon + 1);
    authority = authority.substr(0, colon);
  }
  if (authority.starts_with('[') && authority.ends_with(']')) {
    authority = authority.substr(1, authority.size() - 2);
  }
  address.host = authority;
  if (address.host.empty() || address.port.empty()) return std::nullopt;
  return address;
}

using Plain = beast::tcp_stream;
using Secure = beast::ssl_stream<beast::tcp_stream>;

/// One request over `Stream`, from the name's resolution to the answer's last byte.
template <class Stream>
class Question {
 public:
  template <class... StreamOptions>
  Question(asio::io_context& io, const Address& address, std::chrono::milliseconds patience,
           StreamOptions&... options)
      : stream_(io, options...) {
    beast::get_lowest_layer(stream_).expires_after(patience);
    request_.method(http::verb::get);
    request_.target(address.target);
    request_.version(11);
    request_.set(http::field::host, address.host + ":" + address.port);
    request_.set(http::field::connection, "close");
    const auto found = asio::ip::tcp::resolver(io).resolve(address.host, address.port, error_);
    if (error_) return;
    beast::get_lowest_layer(stream_).async_connect(
        found, [this](error_code error, const auto&) { next(error, &Question::secure); });
    io.run();
  }

  HealthAnswer answer() const {
    if (error_) return {.healthy = false, .text = error_.message()};
    std::string text = response_.body();
    text.resize(std::min(text.find('\n'), text.size()));
    return {.healthy = response_.result() == http::status::ok,
            .text = fmt::format("{} {}", response_.result_int(), text)};
  }

 private:
  void next(error_code error, void (Question::*step)()) {
    error_ = error;
    if (!error) (this->*step)();
  }

  void secure() {
    if constexpr (std::is_same_v<Stream, Secure>) {
      stream_.async_handshake(asio::ssl::stream_base::client,
                              [this](error_code error) { next(error, &Question::ask); });
    } else {
      ask();
    }
  }

  void ask() {
    http::async_write(stream_, request_,
                      [this](error_code error, std::size_t) { next(error, &Question::listen); });
  }

  void listen() {
    http::async_read(stream_, buffer_, response_,
                     [this](error_code error, std::size_t) { error_ = error; });
  }

  Stream stream_;
  http::request<http::empty_body> request_;
  http::response<http::string_body> response_;
  beast::flat_buffer buffer_;
  error_code error_;
};

HealthAnswer ask_securely(const Address& address, const std::string& authorities,
                          std::chrono::milliseconds patience) {
  asio::ssl::context context(asio::ssl::context::tls_client);
  error_code error;
  // On the way to this very machine nobody can stand in between, and the certificate is made out
  // to the name that others know.
  if (is_loopback(address.host) && authorities.empty()) {
    context.set_verify_mode(asio::ssl::verify_none, error);
  } else {
    context.set_verify_mode(asio::ssl::verify_peer, error);
    context.set_verify_callback(asio::ssl::host_name_verification(address.host), error);
    if (authorities.empty()) {
      context.set_default_verify_paths(error);
    } else {
      context.load_verify_file(authorities, error);
    }
  }
  if (error) return {.healthy = false, .text = authorities + ": " + error.message()};
  asio::io_context io;
  return Question<Secure>(io, address, patience, context).answer();
}

}  // namespace

HealthAnswer ask_health(const std::string& url, const std::string& authorities,
                        std::chrono::milliseconds patience) {
  const std::optional<Address> address = parse_url(url);
  if (!address) {
    return {.healthy = false, .text = "the address must begin with http:// or https://"};
  }
  if (address->secure) return ask_securely(*address, authorities, patience);
  asio::io_context io;
  return Question<Plain>(io, *address, patience).answer();
}

}  // namespace heliograph::net
