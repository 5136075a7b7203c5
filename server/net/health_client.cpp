#include "net/health_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <string_view>

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
};

std::optional<Address> parse_url(std::string_view url) {
  constexpr std::string_view scheme = "http://";
  if (!url.starts_with(scheme)) return std::nullopt;
  url.remove_prefix(scheme.size());
  const std::size_t slash = std::min(url.find('/'), url.size());
  std::string_view authority = url.substr(0, slash);
  Address address{.host = {}, .port = "80", .target = std::string(url.substr(slash))};
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

class Question {
 public:
  Question(const Address& address, std::chrono::milliseconds patience) : stream_(io_) {
    stream_.expires_after(patience);
    request_.method(http::verb::get);
    request_.target(address.target);
    request_.version(11);
    request_.set(http::field::host, address.host + ":" + address.port);
    request_.set(http::field::connection, "close");
    error_code error;
    const auto found = asio::ip::tcp::resolver(io_).resolve(address.host, address.port, error);
    if (error) {
      finish(error);
      return;
    }
    stream_.async_connect(found, [this](error_code failed, const auto&) {
      if (failed) return finish(failed);
      http::async_write(stream_, request_, [this](error_code unsent, std::size_t) {
        if (unsent) return finish(unsent);
        http::async_read(stream_, buffer_, response_,
                         [this](error_code unread, std::size_t) { finish(unread); });
      });
    });
    io_.run();
  }

  HealthAnswer answer() const {
    if (error_) return {.healthy = false, .text = error_.message()};
    std::string text = response_.body();
    text.resize(std::min(text.find('\n'), text.size()));
    return {.healthy = response_.result() == http::status::ok,
            .text = fmt::format("{} {}", response_.result_int(), text)};
  }

 private:
  void finish(error_code error) { error_ = error; }

  asio::io_context io_;
  beast::tcp_stream stream_;
  http::request<http::empty_body> request_;
  http::response<http::string_body> response_;
  beast::flat_buffer buffer_;
  error_code error_;
};

}  // namespace

HealthAnswer ask_health(const std::string& url, std::chrono::milliseconds patience) {
  const std::optional<Address> address = parse_url(url);
  if (!address) return {.healthy = false, .text = "the address must begin with http://"};
  return Question(*address, patience).answer();
}

}  // namespace heliograph::net
