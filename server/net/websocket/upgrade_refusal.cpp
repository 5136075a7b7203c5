#include "net/websocket/upgrade_refusal.hpp"

#include <algorithm>
#include <string_view>

#include "protocol/messages/messages.hpp"

namespace heliograph::net {

std::optional<HttpResponse> upgrade_refusal(const HttpRequest& request,
                                            const session::SessionRegistry& sessions) {
  if (request.path != "/ws") return text_response(404, "The WebSocket is at /ws.");
  // 16 bytes in base64, RFC 6455 section 4.1. The version is the WebSocket's own matter.
  const std::string_view key = request.header("sec-websocket-key");
  if (key.size() != 24 || !key.ends_with("==")) {
    return text_response(400, "Sec-WebSocket-Key must be 16 bytes in base64.");
  }
  const auto offered = header_elements(request.header("sec-websocket-protocol"));
  if (std::find(offered.begin(), offered.end(), protocol::protocol_name) == offered.end()) {
    return text_response(400,
                         "This server speaks the subprotocol heliograph.v1; offer it in "
                         "Sec-WebSocket-Protocol.");
  }
  const auto session = sessions.find(session_of(request));
  if (!session) return text_response(404, session.error().message);
  return std::nullopt;
}

}  // namespace heliograph::net
