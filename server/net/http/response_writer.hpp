#pragma once

#include <boost/beast/http/serializer.hpp>
#include <optional>

#include "net/http/beast_messages.hpp"
#include "net/io_handler.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// Writes the responses of a connection, one at a time, as fast as its client reads them.
class ResponseWriter {
 public:
  explicit ResponseWriter(ServerContext& context)
      : context_(context), outgoing_(context.outgoing_bytes) {}

  /// Counts the response; where too many bytes wait to be read, the client is told to try later.
  /// `stream` lives until `done`, which gets the error code.
  void write(ClientStream& stream, HttpResponse answer, const Framing& framing, IoHandler done);
  /// Releases what was written.
  void finish();

 private:
  template <class Message>
  using Serializer = beast::http::response_serializer<typename Message::body_type>;

  ServerContext& context_;
  OutgoingBytes outgoing_;
  BeastResponse response_;
  std::optional<Serializer<BeastResponse>> serializer_;
  std::optional<BeastDownload> download_;
  std::optional<Serializer<BeastDownload>> download_serializer_;
};

}  // namespace heliograph::net
