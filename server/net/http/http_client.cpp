#include "net/http/http_client.hpp"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <optional>
#include <string_view>

#include "net/client_stream.hpp"
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

/// One request, from the name's resolution to the response's last byte.
class Exchange {
 public:
  /// `context`: null for plain HTTP
  Exchange(asio::io_context& io, const Address& address, const ClientRequest& asked,
           std::shared_ptr<asio::ssl::context> context)
      : deadline_(std::chrono::steady_clock::now() + asked.timeout),
        connecting_(io),
        context_(std::move(context)) {
    request_.method_string(asked.method);
    request_.target(address.target);
    request_.version(11);
    request_.set(http::field::host, address.host + ":" + address.port);
    request_.set(http::field::connection, "close");
    for (const auto& [name, value] : asked.headers) request_.set(name, value);
    request_.body() = asked.body;
    if (asked.method != "GET") request_.prepare_payload();
    const auto found = asio::ip::tcp::resolver(io).resolve(address.host, address.port, error_);
    if (error_) return;
    connecting_.expires_at(deadline_);
    connecting_.async_connect(
        found, [this](error_code error, const auto&) { next(error, &Exchange::secure); });
    io.run();
  }

  ClientAnswer answer() const {
    if (error_) return {.status = 0, .body = {}, .error = error_.message()};
    return {
        .status = static_cast<int>(response_.result_int()), .body = response_.body(), .error = {}};
  }

 private:
  void next(error_code error, void (Exchange::*step)()) {
    error_ = error;
    if (!error) (this->*step)();
  }

  void secure() {
    stream_.emplace(connecting_.release_socket(), ConnectionLimits::Slot());
    stream_->next_layer().expires_at(deadline_);
    if (!context_) return send();
    stream_->async_secure(context_, asio::ssl::stream_base::client, {},
                          [this](error_code error, std::size_t) { next(error, &Exchange::send); });
  }

  void send() {
    http::async_write(*stream_, request_,
                      IoHandler([this](error_code error) { next(error, &Exchange::receive); }));
  }

  void receive() {
    http::async_read(*stream_, buffer_, response_,
                     IoHandler([this](error_code error) { error_ = error; }));
  }

  const std::chrono::steady_clock::time_point deadline_;
  beast::tcp_stream connecting_;
  const std::shared_ptr<asio::ssl::context> context_;
  std::optional<ClientStream> stream_;
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
  beast::flat_buffer buffer_;
  error_code error_;
};

/// Throws boost::system::system_error if the certificates of `authorities` cannot be loaded.
std::shared_ptr<asio::ssl::context> verifying_context(const Address& address,
                                                      const std::string& authorities) {
  auto context = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_client);
  // The certificate is made out to the server's public name, and nothing on the loopback interface
  // can be intercepted by other machines.
  if (is_loopback(address.host) && authorities.empty()) {
    context->set_verify_mode(asio::ssl::verify_none);
    return context;
  }
  context->set_verify_mode(asio::ssl::verify_peer);
  context->set_verify_callback(asio::ssl::host_name_verification(address.host));
  if (authorities.empty()) {
    context->set_default_verify_paths();
  } else {
    context->load_verify_file(authorities);
  }
  return context;
}

}  // namespace

ClientAnswer ask_server(const ClientRequest& request) {
  const auto failed = [](std::string why) {
    return ClientAnswer{.status = 0, .body = {}, .error = std::move(why)};
  };
  const std::optional<Address> address = parse_url(request.url);
  if (!address) return failed("the address must begin with http:// or https://");
  std::shared_ptr<asio::ssl::context> context;
  try {
    if (address->secure) context = verifying_context(*address, request.authorities);
  } catch (const boost::system::system_error& failure) {
    return failed(request.authorities + ": " + failure.code().message());
  }
  asio::io_context io;
  return Exchange(io, *address, request, std::move(context)).answer();
}

}  // namespace heliograph::net
