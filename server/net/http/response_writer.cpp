#include "net/http/response_writer.hpp"

#include <utility>

#include "net/websocket/paced_write.hpp"

namespace heliograph::net {

void ResponseWriter::write(ClientStream& stream, HttpResponse answer, const Framing& framing,
                           IoHandler done) {
  const PaceKeeper keeper({.timeout = idle_timeout, .bytes_per_second = min_bytes_per_second},
                          PaceKeeper::Clock::now());
  if (answer.content && !framing.head_only) {
    download_ = to_download(context_, std::move(answer), framing);
    download_serializer_.emplace(*download_);
    return write_paced(stream, *download_serializer_, keeper, std::move(done));
  }
  if (!outgoing_.has_room(answer.body.size())) {
    answer = retry_later("Too many responses wait to be read by other clients.");
  }
  response_ = to_message(context_, std::move(answer), framing);
  outgoing_.hold(response_.body().size());
  serializer_.emplace(response_);
  write_paced(stream, *serializer_, keeper, std::move(done));
}

void ResponseWriter::finish() {
  serializer_.reset();
  response_ = {};
  download_serializer_.reset();
  download_.reset();
  outgoing_.hold(0);
}

}  // namespace heliograph::net
