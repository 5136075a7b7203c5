#include "gpu/frame_plan/memory_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace heliograph::gpu {
namespace {

constexpr std::uint64_t no_limit = ~std::uint64_t{0};

std::uint64_t total(const MemoryPlan& plan) {
  std::uint64_t bytes = 0;
  for (const std::uint64_t block : plan.block_bytes) bytes += block;
  return bytes;
}

bool in_one_pass(const Lifetime& a, const Lifetime& b) {
  return std::max(a.first, b.first) <= std::min(a.last, b.last);
}

/// As passes of a frame might declare them: few sizes, any lifetimes.
std::vector<Lifetime> random_frame(std::mt19937& random) {
  const auto number = [&](std::uint32_t most) {
    return std::uniform_int_distribution<std::uint32_t>(0, most)(random);
  };
  std::vector<Lifetime> frame(1 + number(39));
  for (Lifetime& lifetime : frame) {
    lifetime.alignment = std::uint64_t{1} << number(12);
    lifetime.bytes = 1 + number(3) * 4096 + number(64);
    lifetime.first = number(30);
    lifetime.last = lifetime.first + number(20);
  }
  return frame;
}

TEST(MemoryPlan, NeverOverlapsWhatIsAliveInTheSamePass) {
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    const std::uint64_t limit = round % 2 ? no_limit : 20000;
    const std::vector<Lifetime> frame = random_frame(random);
    const MemoryPlan plan = plan_memory(frame, limit);
    ASSERT_EQ(plan.places.size(), frame.size());
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const MemoryPlan::Place& a = plan.places[i];
      ASSERT_EQ(a.offset % frame[i].alignment, 0u);
      ASSERT_LT(a.block, plan.block_bytes.size());
      ASSERT_LE(a.offset + frame[i].bytes, plan.block_bytes[a.block]);
      ASSERT_LE(plan.block_bytes[a.block], limit);
      for (std::size_t j = 0; j < i; ++j) {
        const MemoryPlan::Place& b = plan.places[j];
        if (a.block != b.block || !in_one_pass(frame[i], frame[j])) continue;
        ASSERT_TRUE(a.offset + frame[i].bytes <= b.offset || b.offset + frame[j].bytes <= a.offset)
            << "round " << round << ": " << i << " and " << j;
      }
    }
  }
}

TEST(MemoryPlan, SharesWhatIsAliveInDifferentPasses) {
  const std::vector<Lifetime> frame{{100, 1, 0, 3}, {100, 1, 4, 5}, {60, 1, 6, 9}, {40, 1, 6, 7}};
  EXPECT_EQ(total(plan_memory(frame, no_limit)), 100u);
}

TEST(MemoryPlan, KeepsApartWhatOnePassReadsAndWrites) {
  const std::vector<Lifetime> frame{{100, 1, 0, 3}, {100, 1, 3, 5}};
  EXPECT_EQ(total(plan_memory(frame, no_limit)), 200u);
}

TEST(MemoryPlan, GivesWhatExceedsTheLimitABlockOfItsOwn) {
  const std::vector<Lifetime> frame{{100, 1, 0, 1}, {30, 1, 0, 1}, {100, 1, 2, 3}};
  const MemoryPlan plan = plan_memory(frame, 50);
  EXPECT_EQ(plan.block_bytes, (std::vector<std::uint64_t>{100, 30}));
  EXPECT_EQ(plan.places[2].block, plan.places[0].block);
}

TEST(MemoryPlan, UsesWhatIsFreeBesideFixedPlacesWithoutGrowingTheirBlocks) {
  const std::vector<FixedPlace> fixed{{{60, 1, 5, 9}, {0, 0}}, {{40, 1, 3, 9}, {0, 60}}};
  const std::vector<Lifetime> frame{{80, 1, 0, 2}, {60, 1, 3, 4}, {20, 1, 0, 9}};
  const MemoryPlan plan = plan_memory(frame, no_limit, fixed);
  EXPECT_EQ(plan.block_bytes, (std::vector<std::uint64_t>{100, 20}));
  EXPECT_EQ(plan.places[0].block, 0u);
  EXPECT_EQ(plan.places[1].block, 0u);
  EXPECT_EQ(plan.places[1].offset, 0u);
  EXPECT_EQ(plan.places[2].block, 1u);
}

TEST(MemoryPlan, PlacesWhatFewFramesUseBehindEverythingElse) {
  const std::vector<Lifetime> frame{{.bytes = 100, .first = 0, .last = 9, .rare = true},
                                    {.bytes = 60, .first = 0, .last = 4},
                                    {.bytes = 40, .first = 2, .last = 5}};
  const MemoryPlan plan = plan_memory(frame, no_limit);
  EXPECT_EQ(plan.places[1].offset, 0u);
  EXPECT_EQ(plan.places[2].offset, 60u);
  EXPECT_EQ(plan.places[0].offset, 100u);
}

TEST(MemoryPlan, OfNothingHasNoBlocks) {
  EXPECT_TRUE(plan_memory({}, no_limit).block_bytes.empty());
}

}  // namespace
}  // namespace heliograph::gpu
