#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace heliograph::session {

/// Sequence ticket of a step, a capture or a probe in lockstep: they take effect in this order.
using Ticket = std::uint64_t;

/// The smaller of those that there are.
inline std::optional<Ticket> earliest(std::optional<Ticket> a, std::optional<Ticket> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

}  // namespace heliograph::session
