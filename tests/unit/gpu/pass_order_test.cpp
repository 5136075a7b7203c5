#include "gpu/frame_plan/pass_order.hpp"

#include <gtest/gtest.h>

#include "tests/unit/gpu/uses.hpp"

namespace heliograph::gpu {
namespace {

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

TEST(PassOrder, EarlyPassesComeFirst) {
  const std::vector<bool> early = {false, false, false, true, true, false, false};
  const PassOrder order = overlapping_order(two_chains(), early);
  EXPECT_EQ(order.passes, (Numbers{3, 4, 0, 5, 1, 2, 6}));
  EXPECT_EQ(barriers(order), (Numbers{4, 0, 1, 2, 6}));
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
