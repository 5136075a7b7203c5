// Order of passes, barriers, histories, conditions and results.
#include <cstring>

#include "tests/gpu/frame_plan/frame_plan_fixture.hpp"

namespace heliograph::gpu {
namespace {

TEST_F(FramePlanTest, RunsPassesInOrder) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("first", a, b, 2.0f);
  add("second", b, c, 3.0f);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(c), 5.0f);
}

TEST_F(FramePlanTest, EvaluatesConstantsEveryFrame) {
  const auto a = image("a"), b = image("b");
  float amount = 1.0f;
  plan_.pass("add", program_).read(a).write(b).constants([&] { return amount; }).dispatch({13, 9});
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f);
  amount = 4.0f;
  plan_.execute();
  EXPECT_EQ(value(b), 4.0f);
}

TEST_F(FramePlanTest, BarrierBetweenWriteAndRead) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("writes b", a, b);
  add("reads b", b, c);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"reads b"}));
}

TEST_F(FramePlanTest, BarrierBeforeWriteAfterReadOrWrite) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("reads a", a, b);
  add("writes a", c, a);
  add("writes a again", c, a);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"writes a", "writes a again"}));
}

TEST_F(FramePlanTest, NoBarrierBetweenIndependentPasses) {
  const auto a = image("a"), b = image("b"), c = image("c"), d = image("d");
  add("a to b", a, b);
  add("a to c", a, c);
  add("b to d", b, d);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"b to d"}));
}

TEST_F(FramePlanTest, NoBarrierAfterHostPass) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("device", a, b);
  plan_.host("host", [] {});
  add("device after", b, c);
  plan_.compile();
  EXPECT_TRUE(plan_.barriers().empty());
}

TEST_F(FramePlanTest, HistoriesSwapEveryFrameAndReset) {
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.compile();
  for (int frame = 1; frame <= 5; ++frame) {
    plan_.execute();
    EXPECT_EQ(value(history.current), static_cast<float>(frame));
  }
  plan_.reset(history);
  plan_.execute();
  EXPECT_EQ(value(history.current), 1.0f);
}

TEST_F(FramePlanTest, HistoriesKeepTheirContentWhenTheDrawnSizeChanges) {
  const History history = plan_.history("texels", format);
  add("texels", history.previous, history.current, 0.0f);
  plan_.compile();
  const VkExtent2D full = plan_.extent();
  std::vector<float> texels(std::size_t{full.width} * full.height);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<float>(i);
  plan_.latest(history.current).upload(std::as_bytes(std::span(texels)));

  VkExtent2D before = full;
  // No texel of one size lies in the middle between two of the other.
  for (const VkExtent2D drawn : {VkExtent2D{11, 5}, full, {1, 1}}) {
    std::vector<float> expected = texels;
    for (std::uint32_t y = 0; y < drawn.height; ++y) {
      for (std::uint32_t x = 0; x < drawn.width; ++x) {
        const auto column = static_cast<std::uint32_t>((x + 0.5) / drawn.width * before.width);
        const auto row = static_cast<std::uint32_t>((y + 0.5) / drawn.height * before.height);
        expected[y * full.width + x] = texels[row * full.width + column];
      }
    }
    plan_.set_drawn(drawn);
    plan_.execute();
    const auto bytes = plan_.latest(history.current).download();
    std::memcpy(texels.data(), bytes.data(), bytes.size());
    for (std::uint32_t y = 0; y < drawn.height; ++y) {
      for (std::uint32_t x = 0; x < drawn.width; ++x) {
        EXPECT_EQ(texels[y * full.width + x], expected[y * full.width + x]) << x << ", " << y;
      }
    }
    before = drawn;
  }
}

TEST_F(FramePlanTest, ReadsBackRequestedImageEveryFrame) {
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.read_back(history.current);
  plan_.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    plan_.execute();
    const std::vector<std::uint8_t> bytes = plan_.read();
    const auto downloaded = plan_.latest(history.current).download();
    ASSERT_EQ(bytes.size(), downloaded.size());
    EXPECT_EQ(std::memcmp(bytes.data(), downloaded.data(), bytes.size()), 0);
    EXPECT_EQ(value(history.current), static_cast<float>(frame));
  }
}

TEST_F(FramePlanTest, SkipsPassesWhoseConditionIsFalse) {
  const auto a = image("a"), b = image("b");
  bool wanted = false;
  add("maybe", a, b, 7.0f).when([&] { return wanted; });
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 0.0f);
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  wanted = true;
  plan_.execute();
  EXPECT_EQ(value(b), 7.0f);
  EXPECT_GE(plan_.timings()[0].milliseconds, 0.0f);
}

TEST_F(FramePlanTest, WithoutAConditionNoPassIsSkipped) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("always", a, b, 7.0f).when({});
  plan_.only_when(
      {}, [&] { add("first", a, c, 3.0f); }, [&] { add("second", a, c, 4.0f); });
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 7.0f);
  EXPECT_EQ(value(c), 3.0f);
  EXPECT_EQ(plan_.timings().size(), 2u);
}

TEST_F(FramePlanTest, OnlyWhenSkipsAllPassesDeclaredWithin) {
  const auto a = image("a"), b = image("b"), c = image("c"), d = image("d");
  bool outer = false, own = true;
  plan_.only_when([&] { return outer; },
                  [&] {
                    add("first", a, b, 2.0f);
                    add("second", a, c, 3.0f).when([&] { return own; });
                  });
  add("always", a, d, 4.0f);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 0.0f);
  EXPECT_EQ(value(c), 0.0f);
  EXPECT_EQ(value(d), 4.0f);
  outer = true;
  own = false;
  plan_.execute();
  EXPECT_EQ(value(b), 2.0f);
  EXPECT_EQ(value(c), 0.0f) << "its own condition counts too";
  own = true;
  plan_.execute();
  EXPECT_EQ(value(c), 3.0f);
}

TEST_F(FramePlanTest, WhatOneOfTwoPassesWritesIsLeftOutInNoFrame) {
  const auto a = image("a"), either = image("either"), one = image("one");
  bool first = false;
  plan_.only_when([&] { return first; },
                  [&] {
                    add("first", a, either, 2.0f);
                    add("only first", a, one, 5.0f);
                  },
                  [&] { add("second", a, either, 3.0f); });
  plan_.share_memory();
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(either), 3.0f);
  first = true;
  plan_.execute();
  EXPECT_EQ(value(either), 2.0f);
  EXPECT_EQ(value(one), 5.0f);
}

TEST_F(FramePlanTest, ListsEveryWrittenImageOnce) {
  const auto a = image("a"), b = image("b");
  const History history = plan_.history("history", format);
  add("to b", a, b);
  add("to b again", a, b);
  add("to history", b, history.current);
  plan_.compile();
  ASSERT_EQ(plan_.views().size(), 2u);
  EXPECT_EQ(plan_.views()[0].name, "b");
  EXPECT_EQ(plan_.views()[1].name, "history");
}

}  // namespace
}  // namespace heliograph::gpu
