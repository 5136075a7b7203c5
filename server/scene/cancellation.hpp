#pragma once

#include <cstddef>
#include <stop_token>

namespace heliograph::scene {

/// Thrown by a load that is to stop.
struct LoadCancelled {};

inline void throw_if_cancelled(const std::stop_token& stop) {
  if (stop.stop_requested()) throw LoadCancelled();
}

/// In a loop over many small things, with the number of each: asks now and then only.
inline void throw_if_cancelled(const std::stop_token& stop, std::size_t number) {
  if (number % 4096 == 0) throw_if_cancelled(stop);
}

}  // namespace heliograph::scene
