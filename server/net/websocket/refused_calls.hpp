#pragma once

#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace heliograph::net {

/// What answers a message none of whose calls is carried out: the error, with the id of the call,
/// or for each id of a batch; nothing for a notification. The id is null where none can be read.
/// Builds nothing of the message, and reads a single call no further than to its id.
std::string refuse_calls(std::string_view message, const protocol::Error& error);

protocol::Error too_many_messages();
/// `limit` is in words.
protocol::Error answer_too_large(std::string limit);

}  // namespace heliograph::net
