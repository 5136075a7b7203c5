#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>

#include "net/connection.hpp"
#include "net/download/content_body.hpp"
#include "net/http/http_message.hpp"

// Converts between the routes' messages and Beast's. For the sources of this folder only: it brings
// Boost.

namespace heliograph::net {

using BeastRequest = beast::http::request<beast::http::string_body>;
using BeastResponse = beast::http::response<beast::http::string_body>;
using BeastDownload = beast::http::response<ContentBody>;

HttpRequest to_request(BeastRequest&& message, const ClientStream& stream);

/// Refuses chunks whose line another program could end elsewhere. Beast's parser, which keeps a
/// reference to this, lets line feeds pass in the quotes of an extension.
struct ChunkExaminer {
  void operator()(std::uint64_t size, beast::string_view extension,
                  boost::system::error_code& error) const;
};

/// Properties of one response apart from its content.
struct Framing {
  bool keep_alive = false;
  bool head_only = false;  // HEAD: the header of GET, with its length, and no body
  /// CORS headers for pages of allowed origins.
  Headers cors;
};

/// Sets the headers of every response, and those for pages of allowed origins.
void set_usual_headers(beast::http::fields& message, const ServerContext& context,
                       const Headers& cors);

/// The response as it is written, with the headers of every response. Counts it.
BeastResponse to_message(ServerContext& context, HttpResponse answer, const Framing& framing);
/// The same of a response with content.
BeastDownload to_download(ServerContext& context, HttpResponse answer, const Framing& framing);

}  // namespace heliograph::net
