#pragma once

#include <cstdint>
#include <string>

namespace heliograph::session {

// The runtime of sanitizers makes system calls, takes memory and writes reports of its own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool instrumented = true;
#else
inline constexpr bool instrumented = false;
#endif

/// Gives up, for good, whatever this process does not need to decode a file that is open already:
/// files, sockets, processes, and memory beyond `memory_bytes` for its data. What calls the system
/// for more is ended by SIGSYS. @returns why system calls could not be restricted; empty: they are
/// @throws std::system_error where the other limits cannot be set
std::string confine_process(std::uint64_t memory_bytes);

}  // namespace heliograph::session
