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

/// The group of each pass: passes of one group need nothing of each other, and a barrier stands
/// between two groups. Each comes as early as what it uses allows. A pass on the host is alone.
std::vector<std::uint32_t> pass_groups(std::span<const PassUses> passes);

/// Passes by their groups, which needs as few barriers as there can be, so that the device works on
/// several passes at a time; none is moved across a pass on the host. `early`, by number: passes
/// that need nothing of others come before these, in groups of their own.
PassOrder overlapping_order(std::span<const PassUses> passes, const std::vector<bool>& early = {});

}  // namespace heliograph::gpu
