#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "net/http/http_message.hpp"
#include "net/security/connection_limits.hpp"
#include "net/security/failure_limit.hpp"
#include "net/security/tokens.hpp"

namespace heliograph::net {

struct AccessOptions {
  std::string bind_address = "127.0.0.1";
  std::vector<Token> tokens;  // empty: no token is needed
  bool insecure = false;
  std::vector<std::string> allowed_origins;  // "https://example.org:8443"
  std::vector<std::string> allowed_hosts;    // names of the server, without port
  std::vector<std::string> trusted_proxies;  // addresses and ranges
  bool embedded = false;                     // in pages of other sites
};

/// Whether a request is admitted.
struct Admission {
  std::optional<HttpResponse> refusal;  // the response to send; nothing if it is admitted
  Role role = Role::view;
};

/// Decides which requests are admitted, and with which role.
///
/// Host: a page of another site that makes its name resolve to us (DNS rebinding) sends that name;
/// it must be an address, this machine's name or one that is allowed.
/// Origin: browsers send it with every WebSocket and every cross-site request. It must be the very
/// host and port that the request went to, or on the allow-list; compared whole, never by prefix.
/// Sec-Fetch-Site: what pages embed (images, iframes) comes without Origin but with this header.
/// From other sites, and from other ports of the same host, only navigation to the web client is
/// admitted. Token: see TokenSet. A client that sends wrong tokens is rejected for a while.
class AccessControl {
 public:
  /// @throws std::invalid_argument for a token that does not fit into headers, an origin that is
  /// none, a range that is none, or an address other machines reach without either token or
  /// `insecure`
  explicit AccessControl(AccessOptions options);

  /// Tokens are taken from `Authorization: Bearer`, the cookie, or the subprotocol
  /// `heliograph.v1.token.<base64url>`.
  Admission admit(const HttpRequest& request, bool needs_token = true) const;
  /// The same for a token out of a page's address, which is traded for a cookie.
  Admission admit_by(const std::string& token, const HttpRequest& request) const;

  /// The Set-Cookie header of a browser that has presented the token.
  std::string token_cookie(const std::string& token, const HttpRequest& request) const;

  /// The response to a CORS preflight request; nothing if the request is none or the origin is not
  /// on the allow-list.
  std::optional<HttpResponse> preflight(const HttpRequest& request) const;
  /// CORS headers that let a page on the allow-list read the response.
  Headers cors_headers(const HttpRequest& request) const;

  /// The address that the request comes from, as told by proxies that are trusted.
  std::string client_of(const HttpRequest& request) const;
  /// Whether the client speaks TLS, with us or with a proxy that is trusted.
  bool is_secure(const HttpRequest& request) const;

 private:
  std::optional<HttpResponse> check_origin(const HttpRequest& request) const;
  bool host_allowed(std::string_view host) const;
  bool origin_allowed(std::string_view origin, std::string_view host, bool secure) const;
  bool origin_listed(std::string_view origin) const;
  bool is_proxy(std::string_view address) const;
  Admission check_tokens(const std::vector<std::string>& presented,
                         const HttpRequest& request) const;

  const AccessOptions options_;
  const TokenSet tokens_;
  std::vector<std::string> host_names_;
  std::vector<AddressRange> proxies_;
  mutable FailureLimit failures_;
};

/// Whether a page of another origin, other ports of this host included, requests what it may not
/// embed through an element that sends no Origin: an image, an iframe, a link. Browsers say so to
/// hosts that they trust: loopback and HTTPS.
bool embedded_by_other_origin(const HttpRequest& request);

bool is_loopback(std::string_view address);
/// Whether `text` is "http://" or "https://" and a host, with or without port, and nothing else.
bool is_origin(std::string_view text);

}  // namespace heliograph::net
