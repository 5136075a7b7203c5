#pragma once

#include <optional>

#include "net/http/http_message.hpp"
#include "session/session_registry.hpp"

namespace heliograph::net {

/// The error response to a request for an upgrade that no viewer can come from; nothing if valid.
std::optional<HttpResponse> upgrade_refusal(const HttpRequest& request,
                                            const session::SessionRegistry& sessions);

}  // namespace heliograph::net
