#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/frame_plan/pass_order.hpp"

namespace heliograph::gpu {

/// What two frames, one behind the other, share of a resource.
struct FrameResource {
  static constexpr std::uint32_t none = ~0u;

  std::uint32_t before = none;    // whose memory it was in the frame before; none: of no resource
  bool can_be_doubled = false;    // no frame needs what the one before has left in it
  bool read_after_frame = false;  // the device copies it behind the last pass
};

/// Where a frame is divided, in passes from its start in their order.
struct FrameParts {
  std::size_t early = 0;   // passes that may run during the end of the frame before; 0: none
  std::size_t closed = 0;  // behind these, the early passes of the next frame may run
};

/// Frames of which the next begins before the device is done with this one.
struct FrameOverlap {
  PassOrder order;
  FrameParts parts;                    // `early` <= `closed`
  std::vector<std::uint32_t> doubled;  // resources of which frames have their own in turn
};

/// Divides frames such that as few groups of passes as can be follow each other from one frame to
/// the next, where the start of one runs at the same time as the end of the one before. `resources`
/// by number. A pass on the host is early only where nothing but others on the host comes before
/// it.
FrameOverlap overlap_frames(std::span<const PassUses> passes,
                            std::span<const FrameResource> resources);

}  // namespace heliograph::gpu
