#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace heliograph::gpu {

/// What a resource of a frame needs, and in which passes: its content matters from the start of
/// pass `first` to the end of pass `last`.
struct Lifetime {
  std::uint64_t bytes = 0;
  std::uint64_t alignment = 1;  // a power of two
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  bool rare = false;  // few frames use it
};

struct MemoryPlan {
  struct Place {
    std::size_t block = 0;
    std::uint64_t offset = 0;
  };
  std::vector<Place> places;               // of the lifetimes, in their order
  std::vector<std::uint64_t> block_bytes;  // how large each block of memory is
};

/// A resource whose place is given. Blocks that have such resources grow no further than these.
struct FixedPlace {
  Lifetime lifetime;
  MemoryPlan::Place place;
};

/// Places resources in as little memory as first fit finds, the largest first and those of few
/// frames last, such that those alive in the same pass never overlap. The pages that resources of
/// few frames have for themselves stay unused until then. No block is larger than
/// `most_block_bytes`, unless one resource is: that has a block of its own. `fixed`: what lies in
/// the first blocks already.
MemoryPlan plan_memory(std::span<const Lifetime> lifetimes, std::uint64_t most_block_bytes,
                       std::span<const FixedPlace> fixed = {});

}  // namespace heliograph::gpu
