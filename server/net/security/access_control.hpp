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
  std::vector<Token> tokens;  // none: nobody is asked
  bool insecure = false;
  std::vector<std::string> allowed_origins;  // "https://example.org:8443"
  std::vector<std::string> allowed_hosts;    // names of the server, without port
  std::vector<std::string> trusted_proxies;  // addresses and ranges
  bool embedded = false;                     // in pages of other sites
};

/// What comes of a request's looks.
struct Admission {
  std::optional<HttpResponse> refusal;  // the response to send; nothing if it may pass
  Role role = Role::view;
};

/// Who may talk to the server, and what as.
///
/// Host: a page of another site that makes its name resolve to us (DNS rebinding) sends that name;
/// it must be an address, this machine's name or one that is allowed.
/// Origin: browsers send it with every WebSocket and every cross-site request. It must be the very
/// host and port that the request went to, or on the allow-list; compared whole, never by prefix.
/// Sec-Fetch-Site: what pages merely embed (pictures, frames) comes without Origin but with this.
/// From other sites, and from other ports of the same host, only what leads to the viewer's page
/// passes. Token: see TokenSet. A client that shows wrong ones is soon not listened to for a while.
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

  /// The Set-Cookie header of a browser that has shown the token.
  std::string token_cookie(const std::string& token, const HttpRequest& request) const;

  /// The answer to a page of another origin that asks whether it may ask (CORS preflight); nothing
  /// if the request is no such question or the origin is not on the allow-list.
  std::optional<HttpResponse> preflight(const HttpRequest& request) const;
  /// Headers by which the browser lets a page on the allow-list read the answer.
  Headers sharing_headers(const HttpRequest& request) const;

  /// The address that the request comes from, as told by proxies that are trusted.
  std::string client_of(const HttpRequest& request) const;
  /// Whether the client speaks TLS, with us or with a proxy that is trusted.
  bool is_secure(const HttpRequest& request) const;

 private:
  std::optional<HttpResponse> wrong_place(const HttpRequest& request) const;
  bool host_allowed(std::string_view host) const;
  bool origin_allowed(std::string_view origin, std::string_view host, bool secure) const;
  bool origin_listed(std::string_view origin) const;
  bool is_proxy(std::string_view address) const;
  Admission judge(const std::vector<std::string>& shown, const HttpRequest& request) const;

  const AccessOptions options_;
  const TokenSet tokens_;
  std::vector<std::string> host_names_;
  std::vector<AddressRange> proxies_;
  mutable FailureLimit failures_;
};

/// Whether a page of another origin, this host's other ports included, asks for something that is
/// not for it by way of an element that names no origin: a picture, a frame, a link. Browsers say
/// so to hosts that they trust: loopback and HTTPS.
bool embedded_elsewhere(const HttpRequest& request);

bool is_loopback(std::string_view address);
/// Whether `text` is "http://" or "https://" and a host, with or without port, and nothing else.
bool is_origin(std::string_view text);

}  // namespace heliograph::net
