#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/stream_kinds.hpp"

namespace heliograph::stream {

struct CodecChoice {
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  std::optional<std::string> reason;  // why it is not the client's preferred codec
};

/// The first of the client's codecs, in order of its preference, that this server can encode.
CodecChoice choose_codec(const std::vector<std::string>& offered);

}  // namespace heliograph::stream
