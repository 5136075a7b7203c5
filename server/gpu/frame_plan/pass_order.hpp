#pragma once

#include <cstdint>
#include <optional>
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
  bool early = false;    // may run while the device works on the end of the frame before
};

/// Passes by their numbers as declared, in the order in which they run.
struct PassOrder {
  std::vector<std::uint32_t> passes;
  std::vector<bool> barrier_before;  // by number; never of a pass on the host
};

/// Where a frame is divided, in passes from its start in their order.
struct FrameParts {
  std::size_t early = 0;   // passes that may run during the end of the frame before, and those on
                           // the host in front of them; 0: none
  std::size_t closed = 0;  // behind these no pass uses what early ones have written
};

/// By the early passes at the start of the order.
FrameParts divide_frame(const PassOrder& order, std::span<const PassUses> passes);

/// A resource that one of the early passes reads and any pass writes, if there is one: it may still
/// be written by the frame before.
std::optional<std::uint32_t> read_too_early(const PassOrder& order,
                                            std::span<const PassUses> passes);

/// Passes in the order given, with the barriers that this order needs.
PassOrder declared_order(std::span<const PassUses> passes);

/// Passes in an order that needs as few barriers as there can be: between two of them stand all
/// passes that need nothing of each other, so that the device works on several at a time. Each runs
/// as early as what it uses allows, early ones first; none is moved across a pass on the host.
PassOrder overlapping_order(std::span<const PassUses> passes);

}  // namespace heliograph::gpu
