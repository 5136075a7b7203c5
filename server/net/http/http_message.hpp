#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "net/download/content.hpp"
#include "protocol/result.hpp"

namespace heliograph::net {

/// A request as far as the routes need it; independent of the HTTP library.
struct HttpRequest {
  std::string method;
  std::string path;                            // before any '?', as sent
  std::map<std::string, std::string> query;    // decoded
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
  std::string peer;     // address of the other end, which may be a proxy
  bool secure = false;  // came through TLS

  /// The header's value, empty if absent. `name` in lower case.
  std::string_view header(const std::string& name) const;
  std::optional<std::string> parameter(const std::string& name) const;
};

using Headers = std::vector<std::pair<std::string, std::string>>;

struct HttpResponse {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::string body;
  Headers headers;
  std::optional<Content> content{};  // sent instead of the body
};

/// One line of plain text.
HttpResponse text_response(int status, std::string_view text);
HttpResponse json_response(std::string body);

/// The name and value pairs of a query string (without '?'), percent and plus decoded.
std::map<std::string, std::string> parse_query(std::string_view query);

/// A name or value as it stands in a query string: all but unreserved characters percent encoded.
std::string encode_query(std::string_view text);

/// A parameter of the query that is an integer within limits; nothing if it is absent.
protocol::Result<std::optional<std::uint32_t>> number_parameter(const HttpRequest& request,
                                                                const std::string& name,
                                                                std::uint32_t least,
                                                                std::uint32_t most);

/// In lower case: host names, header names and origins are compared so.
std::string lower(std::string_view text);

/// Without the spaces and tabs around it.
std::string_view trimmed(std::string_view text);

/// The session that a request is about: ?enter=NAME, else ?session=NAME, else the main one. With
/// both, the latter is for a balancer, which leads requests with the same value to the same server.
std::string session_of(const HttpRequest& request);

/// The elements of a comma separated header, without white space around them.
std::vector<std::string_view> header_elements(std::string_view value, char separator = ',');

/// Whether browsers show a page of ours at this path, and need a token to do so.
inline bool is_page(std::string_view path) {
  return path == "/" || path == "/api" || path == "/jobs";
}

}  // namespace heliograph::net
