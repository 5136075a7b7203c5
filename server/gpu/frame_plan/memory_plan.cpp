#include "gpu/frame_plan/memory_plan.hpp"

#include <algorithm>
#include <numeric>

namespace heliograph::gpu {
namespace {

struct Placed {
  std::uint64_t offset;
  std::uint64_t end;
  const Lifetime* lifetime;
};

bool overlap_in_time(const Lifetime& a, const Lifetime& b) {
  return a.first <= b.last && b.first <= a.last;
}

std::uint64_t aligned_up(std::uint64_t offset, std::uint64_t alignment) {
  return (offset + alignment - 1) / alignment * alignment;
}

/// The lowest offset at which nothing lies that is alive at the same time. `block` is in the order
/// of offsets.
std::uint64_t lowest_gap(const std::vector<Placed>& block, const Lifetime& lifetime) {
  std::uint64_t offset = 0;
  for (const Placed& other : block) {
    if (!overlap_in_time(*other.lifetime, lifetime)) continue;
    if (offset + lifetime.bytes <= other.offset) break;
    offset = std::max(offset, aligned_up(other.end, lifetime.alignment));
  }
  return offset;
}

void insert_by_offset(std::vector<Placed>& block, const Placed& placed) {
  const auto behind =
      std::upper_bound(block.begin(), block.end(), placed,
                       [](const Placed& a, const Placed& b) { return a.offset < b.offset; });
  block.insert(behind, placed);
}

}  // namespace

MemoryPlan plan_memory(std::span<const Lifetime> lifetimes, std::uint64_t most_block_bytes,
                       std::span<const FixedPlace> fixed) {
  std::vector<std::size_t> order(lifetimes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (lifetimes[a].rare != lifetimes[b].rare) return lifetimes[b].rare;
    return lifetimes[a].bytes > lifetimes[b].bytes;
  });
  MemoryPlan plan{.places = std::vector<MemoryPlan::Place>(lifetimes.size()), .block_bytes = {}};
  std::vector<std::vector<Placed>> blocks;
  for (const auto& [lifetime, place] : fixed) {
    if (place.block >= blocks.size()) {
      blocks.resize(place.block + 1);
      plan.block_bytes.resize(place.block + 1);
    }
    const Placed placed{place.offset, place.offset + lifetime.bytes, &lifetime};
    insert_by_offset(blocks[place.block], placed);
    plan.block_bytes[place.block] = std::max(plan.block_bytes[place.block], placed.end);
  }
  const std::size_t full_blocks = blocks.size();
  for (const std::size_t i : order) {
    const Lifetime& lifetime = lifetimes[i];
    std::size_t number = 0;
    std::uint64_t offset = 0;
    for (; number < blocks.size(); ++number) {
      offset = lowest_gap(blocks[number], lifetime);
      const std::uint64_t own = plan.block_bytes[number];
      if (offset + lifetime.bytes <= (number < full_blocks ? own : std::max(most_block_bytes, own)))
        break;
    }
    if (number == blocks.size()) {
      offset = 0;
      blocks.emplace_back();
      plan.block_bytes.push_back(0);
    }
    const Placed placed{offset, offset + lifetime.bytes, &lifetime};
    insert_by_offset(blocks[number], placed);
    plan.block_bytes[number] = std::max(plan.block_bytes[number], placed.end);
    plan.places[i] = {number, offset};
  }
  return plan;
}

}  // namespace heliograph::gpu
