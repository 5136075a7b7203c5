#pragma once

#include <cstddef>
#include <cstdint>

namespace heliograph::net {

/// Bytes that the other end of a TCP connection has taken so far, as its system acknowledged them.
/// Does not grow where the system does not tell.
std::uint64_t bytes_taken(int socket);

/// Bytes that were written and that the other end has not taken yet.
std::size_t bytes_not_taken(int socket);

/// Sees to it that who vanishes without a word while nothing is sent is noticed within half a
/// minute: the system asks by itself. Where something was sent it only repeats that, for a quarter
/// of an hour.
void notice_absence(int socket);

}  // namespace heliograph::net
