#pragma once

#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace heliograph::net {

/// The response to a message whose calls are rejected: the error with the id of the call, or one
/// for each id of a batch; empty for a notification. The id is null if none can be read. Builds no
/// JSON value of the message, and parses a single call no further than to its id.
std::string reject_calls(std::string_view message, const protocol::Error& error);

protocol::Error too_many_messages();
/// `limit`: for the message, "256 MiB".
protocol::Error answer_too_large(std::string limit);

}  // namespace heliograph::net
