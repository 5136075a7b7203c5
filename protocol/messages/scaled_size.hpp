#pragma once

#include <algorithm>
#include <cstdint>

namespace heliograph::protocol {

/// Width or height of a frame that is sent smaller than it was rendered, to so many percent,
/// rounded: at least 1. The device and the processors encode frames of the same size.
constexpr std::uint32_t scaled_side(std::uint32_t side, int percent) {
  return std::max(1u, (side * static_cast<std::uint32_t>(percent) + 50u) / 100u);
}

}  // namespace heliograph::protocol
