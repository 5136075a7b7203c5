#include "gpu/frame_plan/frame_overlap.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace heliograph::gpu {
namespace {

constexpr std::uint32_t the_whole_frame = std::numeric_limits<std::uint32_t>::max();

/// How much of the frame before must be done, as a number of groups from its start.
class FrameBefore {
 public:
  FrameBefore(std::span<const PassUses> passes, std::span<const std::uint32_t> groups,
              std::span<const FrameResource> resources)
      : resources_(resources), read_(resources.size()), written_(resources.size()) {
    for (std::size_t pass = 0; pass < passes.size(); ++pass) {
      for (const Use& use : passes[pass].uses) {
        const auto keep_last = [&](std::uint32_t& last) {
          last = std::max(last, groups[pass] + 1);
        };
        if (reads(use)) keep_last(read_[use.resource]);
        if (writes(use)) keep_last(written_[use.resource]);
      }
    }
    for (std::size_t i = 0; i < resources.size(); ++i) {
      if (resources[i].read_after_frame) read_[i] = the_whole_frame;
    }
  }

  /// If the resource is not doubled.
  std::uint32_t needed_by(const Use& use) const {
    const std::uint32_t before = resources_[use.resource].before;
    if (before == FrameResource::none) return 0;
    return writes(use) ? std::max(written_[before], read_[before]) : written_[before];
  }
  /// With what can be doubled.
  std::uint32_t needed_by(const PassUses& pass) const {
    std::uint32_t needed = 0;
    for (const Use& use : pass.uses) {
      if (!resources_[use.resource].can_be_doubled) needed = std::max(needed, needed_by(use));
    }
    return needed;
  }

 private:
  std::span<const FrameResource> resources_;
  std::vector<std::uint32_t> read_;     // groups up to the last that does, by resource
  std::vector<std::uint32_t> written_;  // likewise
};

/// What each pass needs of the frame before.
std::vector<std::uint32_t> needed_groups(std::span<const PassUses> passes,
                                         const FrameBefore& before) {
  std::vector<std::uint32_t> needed;
  bool starts = true;
  for (const PassUses& pass : passes) {
    starts = starts && pass.on_host;
    needed.push_back(before.needed_by(pass));
    // The host does not wait for the device.
    if (pass.on_host && (!starts || needed.back() > 0)) needed.back() = the_whole_frame;
  }
  return needed;
}

struct Division {
  PassOrder order;
  FrameParts parts;
  std::size_t overlapping = 0;  // groups of the shorter of the two parts
};

/// With a frame that begins when so many groups of the one before are done.
Division divide(std::span<const PassUses> passes, std::span<const std::uint32_t> groups,
                std::span<const std::uint32_t> needed, std::uint32_t closed) {
  std::vector<bool> early(passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) {
    early[i] = groups[i] < closed && needed[i] <= closed;
  }
  Division made{.order = overlapping_order(passes, early)};
  std::set<std::uint32_t> first;
  std::set<std::uint32_t> last;
  bool starts = true;
  for (const std::uint32_t pass : made.order.passes) {
    starts = starts && early[pass];
    made.parts.early += starts;
    made.parts.closed += groups[pass] < closed;
    if (passes[pass].on_host) continue;
    if (starts) first.insert(groups[pass]);
    if (groups[pass] >= closed) last.insert(groups[pass]);
  }
  made.overlapping = std::min(first.size(), last.size());
  return made;
}

}  // namespace

FrameOverlap overlap_frames(std::span<const PassUses> passes,
                            std::span<const FrameResource> resources) {
  const std::vector<std::uint32_t> groups = pass_groups(passes);
  const FrameBefore before(passes, groups, resources);
  const std::vector<std::uint32_t> needed = needed_groups(passes, before);
  Division best{.order = overlapping_order(passes)};
  std::uint32_t begins = 0;
  const std::uint32_t all = groups.empty() ? 0 : *std::ranges::max_element(groups) + 1;
  for (std::uint32_t closed = 1; closed < all; ++closed) {
    Division other = divide(passes, groups, needed, closed);
    if (other.overlapping <= best.overlapping) continue;
    best = std::move(other);
    begins = closed;
  }
  FrameOverlap overlap{.order = std::move(best.order), .parts = best.parts};
  std::set<std::uint32_t> doubled;
  for (std::size_t i = 0; i < best.parts.early; ++i) {
    for (const Use& use : passes[overlap.order.passes[i]].uses) {
      if (before.needed_by(use) > begins) doubled.insert(use.resource);
    }
  }
  overlap.doubled.assign(doubled.begin(), doubled.end());
  return overlap;
}

}  // namespace heliograph::gpu
