// Arbitrary bytes as an HTTP request. A head that the server examines and does not refuse must mean
// to its parser what the examination has found, or another program would read it differently.
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cstdlib>
#include <string>
#include <string_view>

#include "net/download/byte_range.hpp"
#include "net/http/http_message.hpp"
#include "net/http/request_head.hpp"

using namespace heliograph;
namespace http = boost::beast::http;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// A fault does not go away with the bytes that follow, and the end of the head does not move.
void check_prefixes(std::string_view received, const net::RequestHead& whole) {
  for (const std::size_t part : {received.size() / 3, received.size() / 2, received.size() - 1}) {
    if (part >= received.size()) continue;
    const net::RequestHead head = net::examine_request_head(received.substr(0, part));
    if (!head.fault.empty()) require(!whole.fault.empty());
    if (head.length > 0) require(head.length == whole.length);
  }
}

std::size_t count(const http::fields& fields, http::field name) {
  return fields.count(name);
}

void check_query(const std::string& target) {
  const std::size_t question = std::min(target.find('?'), target.size());
  const auto parameters =
      net::parse_query(std::string_view(target).substr(std::min(question + 1, target.size())));
  std::string again;
  for (const auto& [name, value] : parameters) {
    if (name.empty()) return;  // such a pair cannot be told from a separator
    again += (again.empty() ? "" : "&") + net::encode_query(name) + "=" + net::encode_query(value);
  }
  require(net::parse_query(again) == parameters);
}

/// Parts lie within the whole, whatever range was asked for.
void check_range(const http::fields& fields) {
  constexpr std::uint64_t size = 1000;
  net::HttpRequest request{.method = "GET"};
  for (const auto& field : fields) {
    request.headers[net::lower(std::string(field.name_string()))] = std::string(field.value());
  }
  net::HttpResponse whole;
  whole.headers.emplace_back("ETag", "\"1\"");
  whole.content.emplace();
  whole.content->add(std::string(size, 'x'));
  const net::HttpResponse part = net::requested_part(request, std::move(whole));
  require(part.status == 200 || part.status == 206 || part.status == 304 || part.status == 416);
  if (part.status == 206) require(part.content->size() >= 1 && part.content->size() <= size);
}

void check_parsed(std::string_view received, const net::RequestHead& examined) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(16 * 1024);
  boost::system::error_code error;
  const std::size_t used = parser.put(boost::asio::buffer(received.data(), examined.length), error);
  if (error || !parser.is_header_done()) return;  // refused
  require(used == examined.length);
  const auto& head = parser.get();
  require(count(head, http::field::host) <= 1 && count(head, http::field::content_length) <= 1);
  require(head.version() == 10 || count(head, http::field::host) == 1);
  require(!(parser.chunked() && parser.content_length()));
  require(parser.chunked() == (count(head, http::field::transfer_encoding) == 1));
  require(parser.content_length().has_value() == (count(head, http::field::content_length) == 1));
  for (const auto& field : head) {
    require(field.value().find_first_of("\r\n") == boost::beast::string_view::npos);
  }
  check_query(std::string(head.target()));
  check_range(head);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view received(reinterpret_cast<const char*>(data), size);
  const net::RequestHead head = net::examine_request_head(received);
  require(head.length <= size);
  if (size > 0) check_prefixes(received, head);
  if (head.length > 0 && head.fault.empty()) check_parsed(received, head);
  return 0;
}
