// Which passes of a frame run during the end of the frame before.
#include "gpu/frame_plan/frame_overlap.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/gpu/uses.hpp"

namespace heliograph::gpu {
namespace {

/// As many resources that frames share.
std::vector<FrameResource> shared(std::size_t count) {
  std::vector<FrameResource> all(count);
  for (std::size_t i = 0; i < count; ++i) all[i].before = static_cast<std::uint32_t>(i);
  return all;
}

/// A chain: each pass reads what the one before it wrote, from resource 0 on.
std::vector<PassUses> chain(std::uint32_t passes) {
  std::vector<PassUses> all = {{{writing(0)}}};
  for (std::uint32_t i = 1; i < passes; ++i) all.push_back({{reading(i - 1), writing(i)}});
  return all;
}

Numbers in_turn(std::size_t count) {
  Numbers all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// While passes 3 to 5 work on resources 2 to 5, the next frame may write 0 and 1, not more.
TEST(FrameOverlap, ResourcesThatAreNotReadAnyMoreAreWrittenByTheNextFrame) {
  const FrameOverlap overlap = overlap_frames(chain(6), shared(6));
  EXPECT_EQ(overlap.order.passes, in_turn(6));
  EXPECT_EQ(overlap.parts.early, 2u);
  EXPECT_EQ(overlap.parts.closed, 3u);
  EXPECT_TRUE(overlap.doubled.empty());
}

TEST(FrameOverlap, WhatBothPartsNeedIsDoubled) {
  auto resources = shared(6);
  for (FrameResource& resource : resources) resource.can_be_doubled = true;
  const FrameOverlap overlap = overlap_frames(chain(6), resources);
  EXPECT_EQ(overlap.parts.early, 3u);
  EXPECT_EQ(overlap.parts.closed, 3u);
  EXPECT_EQ(overlap.doubled, (Numbers{2})) << "pass 3 reads it while pass 2 writes it";
}

TEST(FrameOverlap, ReadersOfOneResourceNeedNothingOfEachOther) {
  const std::vector<PassUses> passes = {{{reading(9), writing(0)}},
                                        {{reading(9), reading(0), writing(1)}},
                                        {{reading(9), reading(1), writing(2)}}};
  const FrameOverlap overlap = overlap_frames(passes, shared(10));
  EXPECT_EQ(overlap.parts.early, 1u);
  EXPECT_EQ(overlap.parts.closed, 2u);
}

TEST(FrameOverlap, AFrameThatNeedsTheLastOutputBeginsBehindIt) {
  std::vector<PassUses> passes = chain(6);
  passes[0].uses.push_back(reading(5));
  auto resources = shared(6);
  for (FrameResource& resource : resources) resource.can_be_doubled = true;
  resources[5].can_be_doubled = false;  // its content comes from the frame before
  const FrameOverlap overlap = overlap_frames(passes, resources);
  EXPECT_EQ(overlap.parts.early, 0u);
  EXPECT_EQ(overlap.parts.closed, 0u);
  EXPECT_TRUE(overlap.doubled.empty());
}

/// Passes 0 to 2, then one that writes history 3, of which pass `reader` reads the previous image
/// (4), then three that show it.
std::vector<PassUses> with_history(std::size_t reader) {
  std::vector<PassUses> passes = chain(3);
  passes.push_back({{reading(2), writing(3)}});
  passes.push_back({{reading(3), writing(5)}});
  passes.push_back({{reading(5), writing(6)}});
  passes.push_back({{reading(6), writing(7)}});
  passes[reader].uses.push_back(reading(4));
  return passes;
}

std::vector<FrameResource> with_history_resources() {
  auto resources = shared(8);
  for (FrameResource& resource : resources) resource.can_be_doubled = true;
  resources[3] = {.before = 4};
  resources[4] = {.before = 3};
  return resources;
}

TEST(FrameOverlap, HistoriesAreReadWhenTheFrameBeforeHasWrittenThem) {
  const FrameOverlap overlap = overlap_frames(with_history(0), with_history_resources());
  EXPECT_EQ(overlap.parts.closed, 4u);
  EXPECT_EQ(overlap.parts.early, 4u);
  EXPECT_TRUE(overlap.doubled.empty()) << "what the last three write is only written by them";
}

// The image that the next frame writes is the one that this frame reads at its end.
TEST(FrameOverlap, HistoriesAreWrittenWhenTheFrameBeforeHasReadThem) {
  const FrameOverlap overlap = overlap_frames(with_history(6), with_history_resources());
  EXPECT_EQ(overlap.parts.early, 3u);
  EXPECT_EQ(overlap.parts.closed, 3u) << "pass 3 of the next frame waits for pass 6";
  EXPECT_EQ(overlap.doubled, (Numbers{2}));
}

TEST(FrameOverlap, WhatIsCopiedBehindTheFrameIsNotWrittenBefore) {
  auto resources = shared(6);
  resources[0].read_after_frame = true;
  EXPECT_EQ(overlap_frames(chain(6), resources).parts.early, 0u);
  resources[0].can_be_doubled = true;
  const FrameOverlap overlap = overlap_frames(chain(6), resources);
  EXPECT_EQ(overlap.parts.early, 2u);
  EXPECT_EQ(overlap.doubled, (Numbers{0}));
}

TEST(FrameOverlap, WhatFramesHaveInTurnDelaysNone) {
  std::vector<PassUses> passes = chain(6);
  for (PassUses& pass : passes) pass.uses.push_back({6, Access::read_write});
  auto resources = shared(7);
  EXPECT_EQ(overlap_frames(passes, resources).parts.early, 0u);
  resources[6].before = FrameResource::none;
  EXPECT_EQ(overlap_frames(passes, resources).parts.early, 2u);
}

// The first of two chains needs what is left from the end of the frame before.
TEST(FrameOverlap, PassesThatWaitComeBehindTheEarlyOnes) {
  const std::vector<PassUses> passes = {
      {{reading(5), writing(0)}}, {{writing(1)}},
      {{reading(1), writing(6)}}, {{reading(0), reading(6), writing(2)}},
      {{reading(2), writing(3)}}, {{reading(3), writing(4)}},
      {{reading(4), writing(5)}}};
  const FrameOverlap overlap = overlap_frames(passes, shared(7));
  EXPECT_EQ(overlap.order.passes, (Numbers{1, 0, 2, 3, 4, 5, 6}));
  EXPECT_EQ(barriers(overlap.order), (Numbers{0, 3, 4, 5, 6}));
  EXPECT_EQ(overlap.parts.early, 1u);
  EXPECT_EQ(overlap.parts.closed, 3u);
}

// Two groups would follow each other as before, with one more barrier.
TEST(FrameOverlap, FramesThatWouldGainNothingAreWhole) {
  const std::vector<PassUses> passes = {
      {{reading(0), writing(1)}}, {{reading(0), writing(2)}}, {{reading(1), writing(3)}}};
  const FrameOverlap overlap = overlap_frames(passes, shared(4));
  EXPECT_EQ(overlap.parts.early, 0u);
  EXPECT_EQ(overlap.order.passes, in_turn(3));
}

TEST(FrameOverlap, ChainsAreDividedInTheMiddle) {
  auto resources = shared(8);
  for (FrameResource& resource : resources) resource.can_be_doubled = true;
  const FrameOverlap overlap = overlap_frames(chain(8), resources);
  EXPECT_EQ(overlap.parts.early, 4u);
  EXPECT_EQ(overlap.parts.closed, 4u);
}

TEST(FrameOverlap, PassesOnTheHostAreEarlyOnlyAtTheStart) {
  std::vector<PassUses> passes = chain(6);
  passes.insert(passes.begin(), PassUses{.uses = {}, .on_host = true});
  FrameOverlap overlap = overlap_frames(passes, shared(6));
  EXPECT_EQ(overlap.parts.early, 3u);
  EXPECT_EQ(overlap.parts.closed, 4u);
  passes[0].uses.push_back(writing(5));  // which the device still reads or writes
  EXPECT_EQ(overlap_frames(passes, shared(6)).parts.early, 0u);
  passes = chain(6);
  passes.insert(passes.begin() + 1, PassUses{.uses = {}, .on_host = true});
  EXPECT_EQ(overlap_frames(passes, shared(6)).parts.early, 1u);
}

TEST(FrameOverlap, FramesOfPassesOnTheHostAreWhole) {
  const std::vector<PassUses> passes(4, PassUses{.uses = {}, .on_host = true});
  EXPECT_EQ(overlap_frames(passes, {}).parts.early, 0u);
  EXPECT_EQ(overlap_frames({}, {}).parts.early, 0u);
}

}  // namespace
}  // namespace heliograph::gpu
