#include "gpu/frame_plan/pass_order.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "gpu/frame_plan/used_resources.hpp"

namespace heliograph::gpu {
namespace {

/// Groups of passes that follow each other by a barrier: a pass comes behind the last group that
/// writes what it uses, or that uses what it writes.
class Groups {
 public:
  std::uint32_t group_of(const PassUses& pass) {
    if (pass.on_host) {
      first_ = last_ + 2;
      last_ = first_ - 1;
      return last_;
    }
    std::uint32_t group = first_;
    for (const Use& use : pass.uses) {
      const Accessed& accessed = accessed_[use.resource];
      group = std::max(group, accessed.written);
      if (writes(use)) group = std::max(group, accessed.read);
    }
    for (const Use& use : pass.uses) {
      Accessed& accessed = accessed_[use.resource];
      if (reads(use)) accessed.read = std::max(accessed.read, group + 1);
      if (writes(use)) accessed.written = std::max(accessed.written, group + 1);
    }
    last_ = std::max(last_, group);
    return group;
  }

 private:
  /// The first group behind the accesses so far.
  struct Accessed {
    std::uint32_t read = 0;
    std::uint32_t written = 0;
  };
  std::unordered_map<std::uint32_t, Accessed> accessed_;
  std::uint32_t first_ = 0;  // behind the last pass on the host
  std::uint32_t last_ = 0;
};

/// As many passes one after the other, without barriers.
PassOrder in_turn(std::size_t passes) {
  PassOrder order{std::vector<std::uint32_t>(passes), std::vector<bool>(passes, false)};
  std::iota(order.passes.begin(), order.passes.end(), 0u);
  return order;
}

/// Passes of a frame, in declared order: notes in front of which another group than the first
/// begins.
void sort_by_groups(std::span<std::uint32_t> part, std::span<const PassUses> passes,
                    std::vector<bool>& begins_group) {
  Groups groups;
  std::vector<std::uint32_t> group(passes.size());
  for (const std::uint32_t pass : part) group[pass] = groups.group_of(passes[pass]);
  std::ranges::stable_sort(part, {}, [&](std::uint32_t pass) { return group[pass]; });
  for (std::size_t i = 1; i < part.size(); ++i) {
    begins_group[part[i]] = group[part[i]] != group[part[i - 1]];
  }
}

}  // namespace

PassOrder declared_order(std::span<const PassUses> passes) {
  PassOrder order = in_turn(passes.size());
  UsedResources used;  // since the last barrier
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PassUses& pass = passes[i];
    // A submit lies before and after a host pass, which orders everything.
    if (pass.on_host || used.hold_up(pass)) {
      order.barrier_before[i] = !pass.on_host;
      used.clear();
    }
    if (!pass.on_host) used.add(pass);
  }
  return order;
}

std::vector<std::uint32_t> pass_groups(std::span<const PassUses> passes) {
  Groups groups;
  std::vector<std::uint32_t> group(passes.size());
  std::ranges::transform(passes, group.begin(),
                         [&](const PassUses& pass) { return groups.group_of(pass); });
  return group;
}

PassOrder overlapping_order(std::span<const PassUses> passes, const std::vector<bool>& early) {
  PassOrder order = in_turn(passes.size());
  if (!early.empty()) {
    std::ranges::stable_partition(order.passes, [&](std::uint32_t pass) { return early[pass]; });
  }
  const auto rest = static_cast<std::ptrdiff_t>(std::ranges::count(early, true));
  sort_by_groups(std::span(order.passes).first(rest), passes, order.barrier_before);
  sort_by_groups(std::span(order.passes).subspan(rest), passes, order.barrier_before);
  for (std::size_t i = 1; i < passes.size(); ++i) {
    const std::uint32_t pass = order.passes[i];
    const bool on_host = passes[pass].on_host || passes[order.passes[i - 1]].on_host;
    const bool begins_rest = static_cast<std::ptrdiff_t>(i) == rest;
    order.barrier_before[pass] = !on_host && (order.barrier_before[pass] || begins_rest);
  }
  return order;
}

}  // namespace heliograph::gpu
