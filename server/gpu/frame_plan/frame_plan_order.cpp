// In which order a plan's passes run, and what of a frame runs beside the one before it.

#include <algorithm>
#include <map>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {

// Before anything is made that may be doubled.
void FramePlan::order_passes() {
  const std::vector<PassUses> passes = pass_uses();
  // Where every pass is a submit of its own, there is nothing to overlap.
  if (timed_by_clock()) {
    order_ = declared_order(passes);
    return;
  }
  FrameOverlap overlap = overlap_frames(passes, frame_resources());
  order_ = std::move(overlap.order);
  parts_ = overlap.parts;
  for (const std::uint32_t index : overlap.doubled) resources_[index].doubled = true;
  for (Pass& pass : passes_) {
    for (const Use& use : pass.all_uses()) {
      if (writes(use) && resources_[use.resource].doubled) pass.doubled.push_back(use.resource);
    }
  }
}

std::vector<PassUses> FramePlan::pass_uses() const {
  std::map<std::pair<const Image*, const Buffer*>, std::uint32_t> known;
  const auto physical = [&](Use use) {
    const Resource& resource = resources_[use.resource];
    if (!resource.is_made()) return use;
    use.resource =
        known.try_emplace({resource.images[0], resource.buffers[0]}, use.resource).first->second;
    return use;
  };
  std::vector<PassUses> all;
  for (const Pass& pass : passes_) {
    std::vector<Use> uses = pass.all_uses();
    std::ranges::transform(uses, uses.begin(), physical);
    all.push_back({std::move(uses), pass.program == nullptr});
  }
  return all;
}

std::vector<FrameResource> FramePlan::frame_resources() const {
  std::vector<FrameResource> all;
  for (std::uint32_t i = 0; i < resources_.size(); ++i) {
    const Resource& resource = resources_[i];
    const auto& [even, odd] = resource.buffers;
    FrameResource described{.before = i};
    if (resource.part == Resource::Part::current) described.before = i + 1;
    if (resource.part == Resource::Part::previous) described.before = i - 1;
    if (even != odd) described.before = FrameResource::none;  // one for each frame in turn
    described.can_be_doubled = can_be_doubled(i);
    described.read_after_frame = i == read_back_.index;
    all.push_back(described);
  }
  return all;
}

bool FramePlan::can_be_doubled(std::uint32_t index) const {
  const Resource& resource = resources_[index];
  if (resource.is_made() || resource.part != Resource::Part::none) return false;
  if (resource.buffer_desc && resource.buffer_desc->memory != Memory::device) return false;
  const auto uses = first_and_last_use(index);
  const bool ignored =
      std::ranges::find(ignored_when_skipped_, index) != ignored_when_skipped_.end();
  return uses && uses->first_access == Access::write && (ignored || !reads_left_out(index));
}

}  // namespace heliograph::gpu
