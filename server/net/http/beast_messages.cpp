#include "net/http/beast_messages.hpp"

#include <algorithm>
#include <boost/beast/http/error.hpp>
#include <utility>

#include "net/http/request_head.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;

template <class View>
std::string to_string(const View& view) {
  return std::string(view.data(), view.size());
}

/// Responses with these statuses have no body and no length, RFC 9110 section 8.6.
bool is_bare(int status) {
  return status == 204 || status == 304;
}

template <class Message>
void set_head(Message& message, ServerContext& context, const HttpResponse& answer,
              const Framing& framing) {
  ++context.traffic.responses[answer.status];
  message.version(11);
  message.result(static_cast<unsigned>(answer.status));
  set_usual_headers(message, context, framing.cors);
  if (!answer.content_type.empty()) message.set(http::field::content_type, answer.content_type);
  for (const auto& [name, value] : answer.headers) message.set(name, value);
  message.keep_alive(framing.keep_alive);
}

}  // namespace

void ChunkExaminer::operator()(std::uint64_t, beast::string_view extension,
                               boost::system::error_code& error) const {
  if (!is_plain_chunk_extension({extension.data(), extension.size()})) {
    error = http::error::bad_chunk_extension;
  }
}

HttpRequest to_request(BeastRequest&& message, const ClientStream& stream) {
  HttpRequest request;
  request.method = to_string(message.method_string());
  const std::string target = to_string(message.target());
  const std::size_t question = std::min(target.find('?'), target.size());
  request.path = target.substr(0, question);
  request.query =
      parse_query(std::string_view(target).substr(std::min(question + 1, target.size())));
  for (const auto& field : message) {
    const std::string name = lower(to_string(field.name_string()));
    std::string value = to_string(field.value());
    // Repeated fields are one list, RFC 9110 section 5.2; two hosts or origins then match nothing.
    const auto [entry, first] = request.headers.emplace(name, value);
    if (!first) entry->second += ", " + value;
  }
  request.body = std::move(message.body());
  request.peer = stream.peer();
  request.secure = stream.is_secure();
  return request;
}

void set_usual_headers(http::fields& message, const ServerContext& context, const Headers& cors) {
  for (const auto& [name, value] : context.router.headers()) message.set(name, value);
  message.set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : cors) message.set(name, value);
}

BeastResponse to_message(ServerContext& context, HttpResponse answer, const Framing& framing) {
  BeastResponse message;
  set_head(message, context, answer, framing);
  if (is_bare(answer.status)) return message;
  message.content_length(answer.content ? answer.content->size() : answer.body.size());
  if (!framing.head_only) message.body() = std::move(answer.body);
  return message;
}

BeastDownload to_download(ServerContext& context, HttpResponse answer, const Framing& framing) {
  BeastDownload message;
  set_head(message, context, answer, framing);
  message.body() = *std::move(answer.content);
  message.content_length(message.body().size());
  return message;
}

}  // namespace heliograph::net
