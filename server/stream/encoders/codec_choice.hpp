#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/stream_kinds.hpp"

namespace heliograph::stream {

struct CodecChoice {
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  std::optional<std::string> reason;  // why it is not the one that the client likes best
};

/// The first of the codecs that a client offers, best first, that this server can encode.
CodecChoice choose_codec(const std::vector<std::string>& offered);

}  // namespace heliograph::stream
