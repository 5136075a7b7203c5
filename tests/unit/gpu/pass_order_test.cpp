#include "gpu/frame_plan/pass_order.hpp"

#include <gtest/gtest.h>

namespace heliograph::gpu {
namespace {

using Numbers = std::vector<std::uint32_t>;

Use reading(std::uint32_t resource) {
  return {resource, Access::read};
}
Use writing(std::uint32_t resource) {
  return {resource, Access::write};
}

/// The numbers of passes that a barrier stands in front of, as they run.
Numbers barriers(const PassOrder& order) {
  Numbers behind;
  for (const std::uint32_t pass : order.passes) {
    if (order.barrier_before[pass]) behind.push_back(pass);
  }
  return behind;
}

/// Two chains of three passes, declared one after the other, and a pass that joins them.
std::vector<PassUses> two_chains() {
  return {{{writing(0)}},
          {{reading(0), writing(1)}},
          {{reading(1), writing(2)}},
          {{writing(10)}},
          {{reading(10), writing(11)}},
          {{reading(11), writing(12)}},
          {{reading(2), reading(12), writing(20)}}};
}

TEST(PassOrder, OverlapsIndependentChains) {
  const PassOrder order = overlapping_order(two_chains());
  EXPECT_EQ(order.passes, (Numbers{0, 3, 1, 4, 2, 5, 6}));
  EXPECT_EQ(barriers(order), (Numbers{1, 2, 6}));
}

// The fourth begins the frame; the last that uses what it writes is the fifth.
TEST(PassOrder, EarlyPassesComeFirstAndEndWithTheirLastUser) {
  std::vector<PassUses> passes = two_chains();
  passes[3].early = true;
  const PassOrder order = overlapping_order(passes);
  EXPECT_EQ(order.passes, (Numbers{3, 0, 1, 4, 2, 5, 6}));
  EXPECT_EQ(barriers(order), (Numbers{1, 2, 6}));
  const FrameParts parts = divide_frame(order, passes);
  EXPECT_EQ(parts.early, 1u);
  EXPECT_EQ(parts.closed, 4u);
  EXPECT_FALSE(read_too_early(order, passes));
}

TEST(PassOrder, EarlyPassesMayFollowPassesOnTheHost) {
  std::vector<PassUses> passes = two_chains();
  passes[3].early = true;
  passes.insert(passes.begin(), PassUses{{writing(30)}, true});
  const PassOrder order = overlapping_order(passes);
  EXPECT_EQ(order.passes, (Numbers{0, 4, 1, 2, 5, 3, 6, 7}));
  EXPECT_EQ(barriers(order), (Numbers{2, 3, 7}));
  const FrameParts parts = divide_frame(order, passes);
  EXPECT_EQ(parts.early, 2u);
  EXPECT_EQ(parts.closed, 5u);
  passes[4].uses.push_back(reading(30));
  EXPECT_EQ(read_too_early(order, passes), 30u);
}

TEST(PassOrder, PassesOnTheHostAloneAreNotEarly) {
  std::vector<PassUses> passes = two_chains();
  passes.insert(passes.begin(), PassUses{{writing(30)}, true});
  EXPECT_EQ(divide_frame(overlapping_order(passes), passes).early, 0u);
}

TEST(PassOrder, FramesWithoutEarlyPassesAreWhole) {
  const std::vector<PassUses> passes = two_chains();
  const FrameParts parts = divide_frame(overlapping_order(passes), passes);
  EXPECT_EQ(parts.early, 0u);
  EXPECT_EQ(parts.closed, 0u);
}

TEST(PassOrder, EarlyPassesReadNothingThatPassesWrite) {
  std::vector<PassUses> passes = two_chains();
  passes[0].uses.push_back(reading(20));  // of the frame before
  passes[0].early = true;
  EXPECT_EQ(read_too_early(overlapping_order(passes), passes), 20u);
}

TEST(PassOrder, KeepsTheDeclaredOrderWhereAsked) {
  const PassOrder order = declared_order(two_chains());
  EXPECT_EQ(order.passes, (Numbers{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(barriers(order), (Numbers{1, 2, 4, 5, 6}));
}

TEST(PassOrder, ReadersOfOneResourceRunTogether) {
  const PassOrder order =
      overlapping_order(std::vector<PassUses>{{{writing(0)}}, {{reading(0)}}, {{reading(0)}}});
  EXPECT_EQ(barriers(order), (Numbers{1}));
}

TEST(PassOrder, AWriteWaitsForReadersAndWriters) {
  const std::vector<PassUses> passes = {
      {{reading(0), writing(1)}}, {{reading(1), writing(2)}}, {{writing(0)}}, {{writing(0)}}};
  const PassOrder order = overlapping_order(passes);
  // The third may run beside the second, but not before what the first has read.
  EXPECT_EQ(order.passes, (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(barriers(order), (Numbers{1, 3}));
}

TEST(PassOrder, ReadAndWriteCountsAsBoth) {
  const std::vector<PassUses> passes = {
      {{Use{0, Access::read_write}}}, {{Use{0, Access::read_write}}}, {{reading(0)}}};
  EXPECT_EQ(barriers(overlapping_order(passes)), (Numbers{1, 2}));
}

TEST(PassOrder, NothingCrossesAPassOnTheHost) {
  const std::vector<PassUses> passes = {{{writing(0)}},
                                        {{reading(0), writing(1)}},
                                        {.uses = {}, .on_host = true},
                                        {{writing(5)}},
                                        {{reading(5)}}};
  const PassOrder order = overlapping_order(passes);
  EXPECT_EQ(order.passes, (Numbers{0, 1, 2, 3, 4}));
  // A submit lies before and after it.
  EXPECT_EQ(barriers(order), (Numbers{1, 4}));
}

TEST(PassOrder, PassesOnTheHostFollowEachOther) {
  const std::vector<PassUses> passes = {
      {.uses = {}, .on_host = true}, {.uses = {}, .on_host = true}, {{writing(0)}}};
  const PassOrder order = overlapping_order(passes);
  EXPECT_EQ(order.passes, (Numbers{0, 1, 2}));
  EXPECT_TRUE(barriers(order).empty());
}

}  // namespace
}  // namespace heliograph::gpu
