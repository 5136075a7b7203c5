#pragma once

#include <cstddef>
#include <cstdint>

namespace heliograph::net {

/// Bytes that the peer of a TCP connection has acknowledged so far; 0 if the system does not count.
std::uint64_t bytes_acknowledged(int socket);

/// Bytes that were written and that the peer has not acknowledged yet.
std::size_t bytes_unacknowledged(int socket);

/// Whether the peer has sent its last byte or has reset the connection.
bool peer_has_closed(int socket);

/// Turns on TCP keep-alive: a peer that vanishes while nothing is sent is noticed within half a
/// minute. While data is unacknowledged the system only retransmits, for up to a quarter of an
/// hour.
void enable_keepalive(int socket);

}  // namespace heliograph::net
