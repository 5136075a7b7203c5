#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/frame_plan/bindings.hpp"

namespace heliograph::gpu {

inline bool reads(const Use& use) {
  return use.access != Access::write;
}
inline bool writes(const Use& use) {
  return use.access != Access::read;
}

/// What decides about the place of a pass in a frame.
struct PassUses {
  std::vector<Use> uses;
  bool on_host = false;  // runs on the processor after everything before it is done
};

/// Passes by their numbers as declared, in the order in which they run.
struct PassOrder {
  std::vector<std::uint32_t> passes;
  std::vector<bool> barrier_before;  // by number; never of a pass on the host
};

/// Passes in the order given, with the barriers that this order needs.
PassOrder declared_order(std::span<const PassUses> passes);

/// Passes in an order that needs as few barriers as there can be: between two of them stand all
/// passes that need nothing of each other, so that the device works on several at a time. Each runs
/// as early as what it uses allows; none is moved across a pass on the host.
PassOrder overlapping_order(std::span<const PassUses> passes);

}  // namespace heliograph::gpu
