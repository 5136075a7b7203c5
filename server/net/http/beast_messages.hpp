#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "net/connection.hpp"
#include "net/http/http_message.hpp"

// Between what the routes need and what Beast reads and writes. For the sources of this folder
// only: it brings Boost.

namespace heliograph::net {

using BeastRequest = beast::http::request<beast::http::string_body>;
using BeastResponse = beast::http::response<beast::http::string_body>;

HttpRequest to_request(BeastRequest&& message, const ClientStream& stream);

/// What one answer differs in besides what it says.
struct Framing {
  bool keep_alive = false;
  bool head_only = false;  // HEAD: the head that GET would get, with its length, and no body
  /// For pages of other sites that may read the answer.
  Headers sharing;
};

/// What every answer carries, and what lets pages of other sites read it.
void set_usual_headers(beast::http::fields& message, const ServerContext& context,
                       const Headers& sharing);

/// The answer as it is written, with the headers that all have. Counts it.
BeastResponse to_message(ServerContext& context, HttpResponse answer, const Framing& framing);

}  // namespace heliograph::net
