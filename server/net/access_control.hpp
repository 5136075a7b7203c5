#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "net/http_message.hpp"

namespace heliograph::net {

struct AccessOptions {
  std::string bind_address = "127.0.0.1";
  std::string token;  // empty: none is asked for
  bool insecure = false;
  std::vector<std::string> allowed_origins;  // "https://example.org:8443"
};

/// Who may talk to the server.
///
/// Host: a page of another site that makes its name resolve to us (DNS rebinding) sends that name;
/// it must be an address, this machine's name or one of an allowed origin.
/// Origin: browsers send it with every WebSocket and every cross-site request. It must be the very
/// host and port that the request went to, or on the allow-list; compared whole, never by prefix.
/// Token: compared in a time that does not depend on where the first difference is.
class AccessControl {
 public:
  /// @throws std::invalid_argument for a token that does not fit into headers, an origin that is
  /// none, or an address other machines reach without either token or `insecure`
  explicit AccessControl(AccessOptions options);

  /// Why the request is refused, as the response to send; nothing if it may pass. Tokens are taken
  /// from `Authorization: Bearer`, the cookie, or the subprotocol
  /// `heliograph.v1.token.<base64url>`.
  std::optional<HttpResponse> refusal(const HttpRequest& request, bool needs_token = true) const;

  bool needs_token() const { return !options_.token.empty(); }
  bool is_token(std::string_view candidate) const;
  /// The Set-Cookie header of a browser that has shown the token.
  std::string token_cookie() const;

 private:
  bool host_allowed(std::string_view host) const;
  bool origin_allowed(std::string_view origin, std::string_view host) const;
  bool token_shown(const HttpRequest& request) const;

  const AccessOptions options_;
  std::vector<std::string> host_names_;
};

bool is_loopback(std::string_view address);

}  // namespace heliograph::net
