#include "gpu/frame_plan/pass_order.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

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

/// Where the early passes at the start end, behind those on the host that come first: the device
/// has nothing to do for those. 0: there are none.
std::size_t early_end(const PassOrder& order, std::span<const PassUses> passes) {
  const auto first_device =
      std::ranges::find_if(order.passes, [&](std::uint32_t i) { return !passes[i].on_host; });
  const auto first_late = std::find_if(first_device, order.passes.end(),
                                       [&](std::uint32_t i) { return !passes[i].early; });
  return first_late == first_device ? 0
                                    : static_cast<std::size_t>(first_late - order.passes.begin());
}

bool uses(const PassUses& pass, std::uint32_t resource) {
  return std::ranges::any_of(pass.uses, [&](const Use& use) { return use.resource == resource; });
}

}  // namespace

FrameParts divide_frame(const PassOrder& order, std::span<const PassUses> passes) {
  FrameParts parts{.early = early_end(order, passes)};
  parts.closed = parts.early;
  for (std::size_t i = 0; i < parts.early; ++i) {
    for (const Use& use : passes[order.passes[i]].uses) {
      for (std::size_t user = parts.closed; writes(use) && user < order.passes.size(); ++user) {
        if (uses(passes[order.passes[user]], use.resource)) parts.closed = user + 1;
      }
    }
  }
  return parts;
}

std::optional<std::uint32_t> read_too_early(const PassOrder& order,
                                            std::span<const PassUses> passes) {
  for (std::size_t i = 0; i < early_end(order, passes); ++i) {
    for (const Use& read : passes[order.passes[i]].uses) {
      if (!reads(read)) continue;
      const bool written = std::ranges::any_of(passes, [&](const PassUses& pass) {
        return std::ranges::any_of(pass.uses, [&](const Use& use) {
          return use.resource == read.resource && writes(use);
        });
      });
      if (written) return read.resource;
    }
  }
  return std::nullopt;
}

PassOrder declared_order(std::span<const PassUses> passes) {
  PassOrder order = in_turn(passes.size());
  std::set<std::uint32_t> read;
  std::set<std::uint32_t> written;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PassUses& pass = passes[i];
    const bool hazard = std::ranges::any_of(pass.uses, [&](const Use& use) {
      return written.contains(use.resource) || (writes(use) && read.contains(use.resource));
    });
    // A submit lies before and after a host pass, which orders everything.
    if (hazard || pass.on_host) {
      order.barrier_before[i] = !pass.on_host;
      read.clear();
      written.clear();
    }
    if (pass.on_host) continue;
    for (const Use& use : pass.uses) {
      if (reads(use)) read.insert(use.resource);
      if (writes(use)) written.insert(use.resource);
    }
  }
  return order;
}

PassOrder overlapping_order(std::span<const PassUses> passes) {
  Groups groups;
  std::vector<std::uint32_t> group(passes.size());
  std::ranges::transform(passes, group.begin(),
                         [&](const PassUses& pass) { return groups.group_of(pass); });
  PassOrder order = in_turn(passes.size());
  std::ranges::stable_sort(order.passes, {}, [&](std::uint32_t pass) {
    return std::pair(group[pass], !passes[pass].early);
  });
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const std::uint32_t pass = order.passes[i];
    const bool on_host = passes[pass].on_host || (i > 0 && passes[order.passes[i - 1]].on_host);
    order.barrier_before[pass] = i > 0 && !on_host && group[pass] != group[order.passes[i - 1]];
  }
  return order;
}

}  // namespace heliograph::gpu
