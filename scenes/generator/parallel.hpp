#pragma once

#include <cstddef>
#include <functional>

namespace heliograph::scenes {

/// Runs `body(0 .. count - 1)` on all cores. Rethrows the first exception.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace heliograph::scenes
