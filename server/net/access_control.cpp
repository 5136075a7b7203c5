#include "net/access_control.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "stream/base64.hpp"

namespace heliograph::net {
namespace {

constexpr std::string_view cookie_name = "heliograph_token";
constexpr std::string_view token_protocol = "heliograph.v1.token.";
constexpr std::size_t shortest_token = 8;

bool is_address(std::string_view host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const std::string text(host);
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

/// The name or address of "name:port" or "[::1]:port".
std::string_view without_port(std::string_view authority) {
  if (authority.starts_with('[')) {
    const std::size_t end = authority.find(']');
    return end == std::string_view::npos ? std::string_view() : authority.substr(1, end - 1);
  }
  return authority.substr(0, authority.find(':'));
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// "http://host:8080" -> "host:8080"; empty if it is no web origin.
std::string_view authority_of(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    const std::string_view authority = origin.substr(scheme.size());
    return authority.find_first_of("/@?# ") == std::string_view::npos ? authority
                                                                      : std::string_view();
  }
  return {};
}

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? lower(name.data()) : std::string();
}

bool fits_into_headers(std::string_view token) {
  return std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_' || c == '~';
  });
}

}  // namespace

bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" ||
         (address.starts_with("127.") && is_address(address));
}

AccessControl::AccessControl(AccessOptions options) : options_(std::move(options)) {
  const std::string& token = options_.token;
  if (!token.empty() && (token.size() < shortest_token || !fits_into_headers(token))) {
    throw std::invalid_argument(
        "a token needs at least 8 characters out of letters, digits and -._~");
  }
  if (token.empty() && !options_.insecure && !is_loopback(options_.bind_address)) {
    throw std::invalid_argument("other machines reach " + options_.bind_address +
                                ": give a --token, or --insecure if everybody may watch");
  }
  host_names_ = {"localhost", lower(options_.bind_address)};
  if (!is_loopback(options_.bind_address)) host_names_.push_back(machine_name());
  for (const std::string& origin : options_.allowed_origins) {
    if (authority_of(origin).empty()) {
      throw std::invalid_argument("\"" + origin +
                                  "\" is not an origin such as https://example.org");
    }
    host_names_.push_back(lower(without_port(authority_of(origin))));
  }
}

std::optional<HttpResponse> AccessControl::refusal(const HttpRequest& request,
                                                   bool needs_token) const {
  const std::string_view host = request.header("host");
  if (!host_allowed(host)) {
    return text_response(403, "This server does not go by the name of the Host header.");
  }
  const bool from_page = request.headers.contains("origin");
  if (from_page && !origin_allowed(request.header("origin"), host)) {
    return text_response(403, "Pages of this origin may not use the server; see --allow-origin.");
  }
  if (needs_token && !options_.token.empty() && !token_shown(request)) {
    HttpResponse response =
        text_response(401,
                      "This server asks for a token: open /?token=..., or send it as "
                      "\"Authorization: Bearer\".");
    response.headers.emplace_back("WWW-Authenticate", "Bearer");
    return response;
  }
  return std::nullopt;
}

bool AccessControl::is_token(std::string_view candidate) const {
  const std::string& token = options_.token;
  // Every byte is looked at, whatever the candidate holds.
  unsigned difference = token.size() == candidate.size() ? 0 : 1;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char other = candidate.empty() ? '\0' : candidate[i % candidate.size()];
    difference |= static_cast<unsigned char>(token[i] ^ other);
  }
  return difference == 0 && !token.empty();
}

std::string AccessControl::token_cookie() const {
  return std::string(cookie_name) + "=" + options_.token + "; Path=/; HttpOnly; SameSite=Strict";
}

bool AccessControl::host_allowed(std::string_view host) const {
  const std::string name = lower(without_port(host));
  if (name.empty()) return false;
  // With a token a rebound name gains nothing: it does not carry the cookie.
  if (!options_.token.empty()) return true;
  if (is_loopback(options_.bind_address)) {
    if (is_loopback(name)) return true;
  } else if (is_address(name)) {
    return true;
  }
  return std::find(host_names_.begin(), host_names_.end(), name) != host_names_.end();
}

bool AccessControl::origin_allowed(std::string_view origin, std::string_view host) const {
  const auto& allowed = options_.allowed_origins;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const std::string_view authority = authority_of(origin);
  return !authority.empty() && lower(authority) == lower(host);
}

bool AccessControl::token_shown(const HttpRequest& request) const {
  const std::string_view authorization = request.header("authorization");
  constexpr std::string_view bearer = "Bearer ";
  if (authorization.starts_with(bearer) && is_token(authorization.substr(bearer.size()))) {
    return true;
  }
  for (const std::string_view cookie : header_elements(request.header("cookie"), ';')) {
    const std::size_t equals = std::min(cookie.find('='), cookie.size());
    if (cookie.substr(0, equals) != cookie_name) continue;
    if (is_token(cookie.substr(std::min(equals + 1, cookie.size())))) return true;
  }
  for (const std::string_view protocol :
       header_elements(request.header("sec-websocket-protocol"))) {
    if (!protocol.starts_with(token_protocol)) continue;
    const auto token = stream::base64url_decode(protocol.substr(token_protocol.size()));
    if (token && is_token(*token)) return true;
  }
  return false;
}

}  // namespace heliograph::net
