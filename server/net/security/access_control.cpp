#include "net/security/access_control.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "stream/encoders/base64.hpp"

namespace heliograph::net {
namespace {

constexpr std::string_view cookie_name = "heliograph_token";
constexpr std::string_view bearer = "Bearer ";
constexpr std::string_view token_protocol = "heliograph.v1.token.";
// A request is one guess, not hundreds in as many cookies.
constexpr std::size_t most_tokens_shown = 3;

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

/// The address of "10.1.2.3:4711" or "[::1]:4711", which some proxies write.
std::string_view without_port_of_address(std::string_view text) {
  return is_address(text) ? text : without_port(text);
}

/// Every token that the request shows, wherever it does.
std::vector<std::string> tokens_shown(const HttpRequest& request) {
  std::vector<std::string> presented;
  const std::string_view authorization = request.header("authorization");
  if (authorization.starts_with(bearer))
    presented.emplace_back(authorization.substr(bearer.size()));
  for (const std::string_view cookie : header_elements(request.header("cookie"), ';')) {
    const std::size_t equals = std::min(cookie.find('='), cookie.size());
    if (cookie.substr(0, equals) != cookie_name) continue;
    presented.emplace_back(cookie.substr(std::min(equals + 1, cookie.size())));
  }
  for (const std::string_view protocol :
       header_elements(request.header("sec-websocket-protocol"))) {
    if (!protocol.starts_with(token_protocol)) continue;
    const auto token = stream::base64url_decode(protocol.substr(token_protocol.size()));
    presented.push_back(token.value_or(std::string()));
  }
  if (presented.size() > most_tokens_shown) presented.resize(most_tokens_shown);
  return presented;
}

}  // namespace

bool embedded_by_other_origin(const HttpRequest& request) {
  const std::string_view site = request.header("sec-fetch-site");
  if (site != "cross-site" && site != "same-site") return false;
  // With an origin the allow-list decides. A bearer token is never sent but by who has it; a cookie
  // is, by every port of its host.
  if (request.headers.contains("origin")) return false;
  if (request.header("authorization").starts_with(bearer)) return false;
  const bool page = is_page(request.path) && request.header("sec-fetch-mode") == "navigate";
  return !page && !request.path.starts_with("/health/");
}

bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" ||
         (address.starts_with("127.") && is_address(address));
}

bool is_origin(std::string_view text) {
  return !authority_of(text).empty();
}

AccessControl::AccessControl(AccessOptions options)
    : options_(std::move(options)), tokens_(options_.tokens) {
  if (tokens_.empty() && !options_.insecure && !is_loopback(options_.bind_address)) {
    throw std::invalid_argument("other machines reach " + options_.bind_address +
                                ": pass --token, or --insecure to allow access without one");
  }
  host_names_ = {"localhost", lower(options_.bind_address)};
  if (!is_loopback(options_.bind_address)) host_names_.push_back(machine_name());
  for (const std::string& origin : options_.allowed_origins) {
    if (!is_origin(origin)) {
      throw std::invalid_argument("\"" + origin +
                                  "\" is not an origin such as https://example.org");
    }
    host_names_.push_back(lower(without_port(authority_of(origin))));
  }
  for (const std::string& host : options_.allowed_hosts) {
    if (host.empty() || host.find_first_of("/@?# :*") != std::string::npos) {
      throw std::invalid_argument("\"" + host + "\" is not a host name such as example.org");
    }
    host_names_.push_back(lower(host));
  }
  for (const std::string& proxy : options_.trusted_proxies) proxies_.emplace_back(proxy);
}

Admission AccessControl::admit(const HttpRequest& request, bool needs_token) const {
  if (auto refused = check_origin(request)) return {.refusal = std::move(refused)};
  if (tokens_.empty()) return {.refusal = std::nullopt, .role = Role::control};
  if (!needs_token) return {};
  return check_tokens(tokens_shown(request), request);
}

Admission AccessControl::admit_by(const std::string& token, const HttpRequest& request) const {
  if (auto refused = check_origin(request)) return {.refusal = std::move(refused)};
  return check_tokens({token}, request);
}

std::string AccessControl::token_cookie(const std::string& token,
                                        const HttpRequest& request) const {
  std::string cookie = std::string(cookie_name) + "=" + token + "; Path=/; HttpOnly";
  const bool secure = is_secure(request);
  if (secure) cookie += "; Secure";
  // Within a page of another site only such a cookie is sent. What that site's page itself asks
  // for is refused by its origin.
  cookie += secure && options_.embedded ? "; SameSite=None; Partitioned" : "; SameSite=Strict";
  return cookie;
}

std::optional<HttpResponse> AccessControl::preflight(const HttpRequest& request) const {
  const bool asks =
      request.method == "OPTIONS" && request.headers.contains("access-control-request-method");
  if (!asks || !origin_listed(request.header("origin"))) return std::nullopt;
  if (auto refused = check_origin(request)) return refused;
  HttpResponse response{.status = 204, .content_type = {}, .body = {}, .headers = {}};
  response.headers = {
      {"Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, DELETE"},
      {"Access-Control-Allow-Headers", "Authorization, Content-Type, If-None-Match"},
      {"Access-Control-Max-Age", "600"},
  };
  // From the wide network into a private one, or to loopback.
  if (request.header("access-control-request-private-network") == "true") {
    response.headers.emplace_back("Access-Control-Allow-Private-Network", "true");
  }
  return response;
}

Headers AccessControl::cors_headers(const HttpRequest& request) const {
  if (options_.allowed_origins.empty()) return {};
  if (!origin_listed(request.header("origin"))) return {{"Vary", "Origin"}};
  return {
      {"Vary", "Origin"},
      {"Access-Control-Allow-Origin", std::string(request.header("origin"))},
      {"Access-Control-Allow-Credentials", "true"},
      {"Access-Control-Expose-Headers",
       "ETag, Retry-After, X-Heliograph-Samples, X-Heliograph-Warnings"},
      {"Cross-Origin-Resource-Policy", "cross-origin"},
  };
}

std::string AccessControl::client_of(const HttpRequest& request) const {
  if (!is_proxy(request.peer)) return request.peer;
  // The last proxy adds at the end; what stands before the first untrusted one is hearsay.
  const auto chain = header_elements(request.header("x-forwarded-for"));
  for (auto element = chain.rbegin(); element != chain.rend(); ++element) {
    const std::string_view address = without_port_of_address(*element);
    if (!is_address(address)) break;
    if (!is_proxy(address)) return std::string(address);
  }
  return request.peer;
}

bool AccessControl::is_secure(const HttpRequest& request) const {
  if (request.secure) return true;
  const auto schemes = header_elements(request.header("x-forwarded-proto"));
  return is_proxy(request.peer) && !schemes.empty() && schemes.back() == "https";
}

std::optional<HttpResponse> AccessControl::check_origin(const HttpRequest& request) const {
  const std::string_view host = request.header("host");
  if (!host_allowed(host)) {
    return text_response(403, "The Host header is not a name of this server; see --allow-host.");
  }
  const bool from_page = request.headers.contains("origin");
  if (from_page && !origin_allowed(request.header("origin"), host, request.secure)) {
    return text_response(403, "Pages of this origin may not use the server; see --allow-origin.");
  }
  if (embedded_by_other_origin(request)) {
    return text_response(403, "Pages of other origins may not embed this; see --allow-origin.");
  }
  return std::nullopt;
}

Admission AccessControl::check_tokens(const std::vector<std::string>& presented,
                                      const HttpRequest& request) const {
  const std::string client = client_key(client_of(request));
  const auto now = FailureLimit::Clock::now();
  if (!presented.empty()) {
    if (const auto wait = failures_.wait_of(client, now); wait.count() > 0) {
      HttpResponse response = text_response(429, "Too many wrong tokens from this address.");
      response.headers.emplace_back("Retry-After", std::to_string(wait.count()));
      return {.refusal = std::move(response)};
    }
  }
  for (const std::string& candidate : presented) {
    if (const auto role = tokens_.role_of(candidate)) return {.refusal = {}, .role = *role};
  }
  if (!presented.empty()) failures_.failed(client, now);
  const bool shown = std::ranges::any_of(presented, [](const auto& one) { return !one.empty(); });
  HttpResponse response = text_response(401, shown ? "The token is not valid."
                                                   : "A token is required: open /?token=..., or "
                                                     "send \"Authorization: Bearer TOKEN\".");
  // RFC 6750, section 3.
  response.headers.emplace_back("WWW-Authenticate",
                                shown ? "Bearer error=\"invalid_token\"" : "Bearer");
  return {.refusal = std::move(response)};
}

bool AccessControl::host_allowed(std::string_view host) const {
  const std::string name = lower(without_port(host));
  if (name.empty()) return false;
  // With a token a rebound name gains nothing: it does not carry the cookie.
  if (!tokens_.empty()) return true;
  if (is_loopback(options_.bind_address)) {
    if (is_loopback(name)) return true;
  } else if (is_address(name)) {
    return true;
  }
  return std::find(host_names_.begin(), host_names_.end(), name) != host_names_.end();
}

/// Without TLS of our own a proxy may have some, so that the scheme of the page tells nothing.
bool AccessControl::origin_allowed(std::string_view origin, std::string_view host,
                                   bool secure) const {
  if (origin_listed(origin)) return true;
  if (secure && !origin.starts_with("https://")) return false;
  const std::string_view authority = authority_of(origin);
  return !authority.empty() && lower(authority) == lower(host);
}

bool AccessControl::origin_listed(std::string_view origin) const {
  const auto& allowed = options_.allowed_origins;
  return std::find(allowed.begin(), allowed.end(), origin) != allowed.end();
}

bool AccessControl::is_proxy(std::string_view address) const {
  return std::any_of(proxies_.begin(), proxies_.end(),
                     [&](const AddressRange& range) { return range.contains(address); });
}

}  // namespace heliograph::net
