#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "net/client_stream.hpp"
#include "net/connection.hpp"
#include "net/http/http_message.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// Receives the body of an upload into its file, and has it checked: a part of its connection.
class UploadReceiver {
 public:
  using Parser = beast::http::request_parser<beast::http::file_body>;
  using Answer = std::function<void(HttpResponse)>;

  explicit UploadReceiver(ServerContext& context) : context_(context) {}

  /// Takes over the parser of a request, of which the head is known, if its body may be received.
  /// @return why it is not: the client may not upload, or the address or the length is wrong
  std::optional<HttpResponse> begin(const HttpRequest& request,
                                    beast::http::request_parser<beast::http::string_body>& parser);
  const Parser::value_type& head() const { return parser_->get(); }
  /// Receives the body, and calls `answer` on the network thread when the file was checked. Where
  /// the client goes before, or is too slow, it is not called. It keeps the connection, of which
  /// `stream` and `buffer` are parts.
  void receive(ClientStream& stream, beast::flat_buffer& buffer, Answer answer);

 private:
  void received(boost::system::error_code error, ClientStream& stream, beast::flat_buffer& buffer,
                Answer answer);
  void check(ClientStream& stream, Answer answer);

  ServerContext& context_;
  std::shared_ptr<session::UploadStore::Incoming> incoming_;
  std::optional<Parser> parser_;
  std::chrono::steady_clock::time_point deadline_;
};

/// Deletes the upload at the address of a request: 204. It stays where it is shown.
HttpResponse delete_upload(const ServerContext& context, const HttpRequest& request);

}  // namespace heliograph::net
