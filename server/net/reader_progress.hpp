#pragma once

#include <cstdint>

namespace heliograph::net {

/// Bytes that the other end of a TCP connection has taken so far, as its system acknowledged them.
/// Does not grow where the system does not tell.
std::uint64_t bytes_taken(int socket);

/// Sees to it that who vanishes without a word is noticed within half a minute, also where nothing is
/// sent: the system asks by itself, and gives up what is not acknowledged.
void notice_absence(int socket);

}  // namespace heliograph::net
