#pragma once

#include <cstddef>
#include <string_view>

namespace heliograph::net {

/// What is known of the head of a request, its request line and headers, as bytes that were not
/// parsed yet.
struct RequestHead {
  std::size_t length = 0;  ///< with the empty line at its end; 0 while that is missing
  /// Why it must be refused, one sentence: another program, such as a proxy in front of this one,
  /// may read it differently (RFC 9112 sections 2.2, 3.2, 5.2 and 6). Empty: nothing is wrong.
  std::string_view fault;
};

/// `received`: everything from the first byte of a request on.
RequestHead examine_request_head(std::string_view received);

/// Whether what follows the size of a chunk in its line means the same to every program. A control
/// character, even in quotes, may end the line elsewhere (RFC 9112 section 7.1.1).
bool is_plain_chunk_extension(std::string_view extension);

}  // namespace heliograph::net
