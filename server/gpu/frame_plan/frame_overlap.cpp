#include "gpu/frame_plan/frame_overlap.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "gpu/frame_plan/used_resources.hpp"

namespace heliograph::gpu {
namespace {

constexpr std::uint32_t the_whole_frame = std::numeric_limits<std::uint32_t>::max();

/// How much of the frame before must be done, as the number of steps from its start. Steps are the
/// groups or the places of its passes, as given for each.
class FrameBefore {
 public:
  FrameBefore(std::span<const PassUses> passes, std::span<const std::uint32_t> steps,
              std::span<const FrameResource> resources)
      : resources_(resources), read_(resources.size()), written_(resources.size()) {
    for (std::size_t pass = 0; pass < passes.size(); ++pass) {
      for (const Use& use : passes[pass].uses) {
        const auto keep_last = [&](std::uint32_t& last) { last = std::max(last, steps[pass] + 1); };
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
  /// With all doubled that can be.
  std::uint32_t needed_by(const PassUses& pass) const {
    std::uint32_t needed = 0;
    for (const Use& use : pass.uses) {
      if (!resources_[use.resource].can_be_doubled) needed = std::max(needed, needed_by(use));
    }
    return needed;
  }

 private:
  std::span<const FrameResource> resources_;
  std::vector<std::uint32_t> read_;     // steps up to the last pass that does, by resource
  std::vector<std::uint32_t> written_;  // likewise
};

/// Those of the `wanted` passes, by number, that need nothing of others in their own frame: of
/// passes that are not wanted, or of the device on the host.
std::vector<bool> without_needs(std::span<const PassUses> passes, std::vector<bool> wanted) {
  UsedResources others;
  bool behind_device = false;
  bool behind_host = false;  // that is not wanted
  for (std::size_t i = 0; i < passes.size(); ++i) {
    wanted[i] = wanted[i] && !others.hold_up(passes[i]) && !behind_host &&
                !(passes[i].on_host && behind_device);
    behind_device |= !passes[i].on_host;
    if (wanted[i]) continue;
    behind_host |= passes[i].on_host;
    others.add(passes[i]);
  }
  return wanted;
}

/// Groups of passes on the device from one place of the order to another.
std::size_t count_groups(const PassOrder& order, std::span<const PassUses> passes,
                         std::size_t first, std::size_t last) {
  std::size_t count = 0;
  bool begins = true;
  for (std::size_t place = first; place < last; ++place) {
    const std::uint32_t pass = order.passes[place];
    count += !passes[pass].on_host && (begins || order.barrier_before[pass]);
    begins = passes[pass].on_host;
  }
  return count;
}

/// From one frame to the next: of the parts at the same time, those of the longer one.
std::size_t groups_in_turn(const FrameOverlap& overlap, std::span<const PassUses> passes) {
  const auto& [early, closed] = overlap.parts;
  return std::max(count_groups(overlap.order, passes, 0, early),
                  count_groups(overlap.order, passes, closed, passes.size())) +
         count_groups(overlap.order, passes, early, closed);
}

/// With these early passes.
FrameOverlap divide(std::span<const PassUses> passes, std::span<const FrameResource> resources,
                    const std::vector<bool>& early) {
  FrameOverlap made{.order = overlapping_order(passes, early)};
  made.parts.early = static_cast<std::size_t>(std::ranges::count(early, true));
  std::vector<std::uint32_t> places(passes.size());
  for (std::uint32_t place = 0; place < passes.size(); ++place) {
    places[made.order.passes[place]] = place;
  }
  const FrameBefore before(passes, places, resources);
  made.parts.closed = made.parts.early;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (!early[i]) continue;
    made.parts.closed = std::max<std::size_t>(made.parts.closed, before.needed_by(passes[i]));
  }
  std::set<std::uint32_t> doubled;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    for (const Use& use : passes[i].uses) {
      if (early[i] && before.needed_by(use) > made.parts.closed) doubled.insert(use.resource);
    }
  }
  made.doubled.assign(doubled.begin(), doubled.end());
  return made;
}

}  // namespace

FrameOverlap overlap_frames(std::span<const PassUses> passes,
                            std::span<const FrameResource> resources) {
  const std::vector<std::uint32_t> groups = pass_groups(passes);
  const FrameBefore before(passes, groups, resources);
  FrameOverlap best{.order = overlapping_order(passes)};
  std::size_t least = groups_in_turn(best, passes);
  const std::uint32_t all = groups.empty() ? 0 : *std::ranges::max_element(groups) + 1;
  // The next frame begins behind so many groups of this order, or later: early passes change it.
  for (std::uint32_t closed = 1; closed < all; ++closed) {
    std::vector<bool> wanted(passes.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const std::uint32_t needed = before.needed_by(passes[i]);
      // The host does not wait for the device.
      wanted[i] = groups[i] < closed && needed <= (passes[i].on_host ? 0 : closed);
    }
    FrameOverlap divided = divide(passes, resources, without_needs(passes, std::move(wanted)));
    const std::size_t in_turn = groups_in_turn(divided, passes);
    if (in_turn >= least) continue;
    least = in_turn;
    best = std::move(divided);
  }
  return best;
}

}  // namespace heliograph::gpu
