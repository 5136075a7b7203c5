#pragma once

#include "net/http/http_message.hpp"

namespace heliograph::net {

/// What a request for a part of a response gets, RFC 9110 section 14: 206 with the part, 416 where
/// it lies beyond the end. Unchanged: several parts, a part of another version (If-Range), units
/// other than bytes. 304 where the client has the version already. The response has its content
/// and an ETag.
HttpResponse requested_part(const HttpRequest& request, HttpResponse whole);

}  // namespace heliograph::net
