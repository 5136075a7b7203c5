// Frames that are canceled, and those that begin while the device works on others.
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/gpu/frame_plan/frame_plan_fixture.hpp"

namespace heliograph::gpu {
namespace {

TEST_F(FramePlanTest, CanceledFrameDoesNotSwapHistories) {
  if (!device_.is_cpu()) GTEST_SKIP() << "frames are canceled on CPU devices only";
  const auto a = image("a"), b = image("b");
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  add("behind", a, b);
  plan_.compile();
  EXPECT_TRUE(plan_.execute());
  for (const int passes : {0, 1}) {
    int asked = 0;
    EXPECT_FALSE(plan_.execute([&] { return asked++ == passes; }));
    EXPECT_EQ(asked, passes + 1) << "no pass runs after the one that was refused";
  }
  EXPECT_TRUE(plan_.execute([] { return false; }));
  EXPECT_EQ(value(history.current), 2.0f);
}

TEST_F(FramePlanTest, PassesSeeThatTheirFrameIsCanceled) {
  if (!device_.is_cpu()) GTEST_SKIP() << "frames are canceled on CPU devices only";
  int asked = 0, seen = 0;
  bool behind = false;
  plan_.host("long", [&] {
    for (int i = 0; i < 10; ++i) seen += plan_.is_canceled();
  });
  plan_.host("behind", [&] { behind = true; });
  plan_.finish_frames_from_here();
  plan_.host("last", [&] { EXPECT_FALSE(plan_.is_canceled()) << "too late"; });
  plan_.compile();
  EXPECT_FALSE(plan_.execute([&] { return asked++ == 4; })) << "also if it is true only once";
  EXPECT_EQ(asked, 5) << "once before the pass, then in it until it was true";
  EXPECT_EQ(seen, 7);
  EXPECT_FALSE(behind);
  asked = 0;
  EXPECT_TRUE(plan_.execute([&] { return asked++ > 11; })) << "asked 12 times before the end";
  EXPECT_TRUE(behind);
  EXPECT_FALSE(plan_.is_canceled());
  EXPECT_TRUE(plan_.execute());
}

// As renderers of two sessions do.
TEST_F(FramePlanTest, OneFrameBeginsWhileTheDeviceWorksOnAnother) {
  const auto a = image("a"), b = image("b");
  add("add", a, b, 2.0f);
  plan_.read_back(b);
  plan_.compile();
  FramePlan other(device_, {5, 3});
  const History count = other.history("count", format);
  other.pass("count", program_)
      .read(count.previous)
      .write(count.current)
      .constants(1.0f)
      .dispatch(other.extent());
  other.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    EXPECT_TRUE(plan_.begin());
    EXPECT_TRUE(other.begin());
    EXPECT_EQ(plan_.in_flight(), !device_.is_cpu());
    plan_.finish();
    EXPECT_FALSE(plan_.in_flight());
    other.finish();
    EXPECT_EQ(value(b), 2.0f);
    const auto bytes = other.latest(count.current).download();
    EXPECT_EQ(*reinterpret_cast<const float*>(bytes.data()), float(frame));
  }
}

// More than a device has queues.
TEST_F(FramePlanTest, ManyPlansHaveFramesInFlight) {
  struct Counter {
    Counter(const Device& device, const ComputeProgram& program, float step)
        : plan(device, {64, 64}), count(plan.history("count", format)) {
      plan.pass("count", program)
          .read(count.previous)
          .write(count.current)
          .constants(step)
          .dispatch(plan.extent());
      plan.compile();
    }
    FramePlan plan;
    History count;
  };
  std::vector<std::unique_ptr<Counter>> counters;
  for (int i = 1; i <= 9; ++i) {
    counters.push_back(std::make_unique<Counter>(device_, program_, static_cast<float>(i)));
  }
  constexpr int frames = 20;
  for (int frame = 0; frame < frames; ++frame) {
    for (const auto& counter : counters) EXPECT_TRUE(counter->plan.begin());
    for (const auto& counter : counters) counter->plan.finish();
  }
  for (std::size_t i = 0; i < counters.size(); ++i) {
    const auto bytes = counters[i]->plan.latest(counters[i]->count.current).download();
    EXPECT_EQ(*reinterpret_cast<const float*>(bytes.data()), static_cast<float>(frames * (i + 1)));
  }
}

TEST_F(FramePlanTest, MayEndWhileTheDeviceWorksOnItsFrame) {
  const auto a = image("a"), b = image("b");
  add("add", a, b);
  plan_.compile();
  {
    FramePlan other(device_, {512, 512});
    const auto from = other.image("from", format), to = other.image("to", format);
    other.pass("add", program_).read(from).write(to).constants(1.0f).dispatch(other.extent());
    other.compile();
    EXPECT_TRUE(other.begin());
  }
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f);
}

TEST_F(FramePlanTest, FramesBeginAndFinishInTurn) {
  const auto a = image("a"), b = image("b");
  add("add", a, b);
  plan_.compile();
  EXPECT_THROW(plan_.finish(), GpuError);
  plan_.begin();
  if (!device_.is_cpu()) plan_.begin();
  EXPECT_THROW(plan_.begin(), GpuError);
  plan_.finish();
}

TEST_F(FramePlanTest, TheNextFrameBeginsWhileTheDeviceWorksOnOne) {
  if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.read_back(history.current);
  plan_.compile();
  plan_.execute();  // with timers
  const auto count = [&] {
    float value = 0.0f;
    std::memcpy(&value, plan_.read().data(), sizeof value);
    return value;
  };
  plan_.begin();
  for (int frame = 2; frame <= 9; ++frame) {
    ASSERT_TRUE(plan_.can_begin_another());
    plan_.begin();
    EXPECT_FALSE(plan_.can_begin_another()) << "two are enough";
    plan_.finish();
    EXPECT_EQ(count(), static_cast<float>(frame));
  }
  plan_.finish();
  EXPECT_EQ(count(), 10.0f);
}

/// A plan whose frames overlap: six images, of which each pass writes one from the one before, and
/// the third is doubled. The first is the number of the frame.
class OverlappingFramePlanTest : public FramePlanTest {
 protected:
  void SetUp() override {
    if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
    ImageRef from = image("zero");
    plan_.share_memory();
    plan_.only_when([this] { return runs_; },
                    [&] {
                      for (std::size_t i = 0; i < images_.size(); ++i) {
                        images_[i] = plan_.image("image " + std::to_string(i), format);
                        declare(from, images_[i], i == 0);
                        from = images_[i];
                      }
                    });
  }
  void declare(ImageRef from, ImageRef to, bool first) {
    plan_.pass("pass", program_)
        .read(from)
        .write(to)
        .constants([this, first] { return first ? number_ : 0.0f; })
        .dispatch(plan_.extent());
  }
  float shown() {
    float value = 0.0f;
    std::memcpy(&value, plan_.read().data(), sizeof value);
    return value;
  }

  float number_ = 1.0f;
  bool runs_ = true;
  std::array<ImageRef, 6> images_;
};

TEST_F(OverlappingFramePlanTest, TheStartOfAFrameRunsDuringTheEndOfTheOneBefore) {
  const History count = plan_.history("count", format);
  add("count", count.previous, count.current);
  plan_.read_back(images_.back());
  plan_.compile();
  plan_.execute();  // with timers
  number_ = 2.0f;
  plan_.begin();
  for (int frame = 3; frame <= 14; ++frame) {
    number_ = static_cast<float>(frame);
    ASSERT_TRUE(plan_.can_begin_another());
    plan_.begin();
    plan_.finish();
    EXPECT_EQ(shown(), static_cast<float>(frame - 1));
    EXPECT_EQ(value(count.current), static_cast<float>(frame - 1));
  }
  plan_.finish();
  EXPECT_EQ(shown(), 14.0f);
}

TEST_F(OverlappingFramePlanTest, FramesHaveTheirOwnOfWhatBothPartsUse) {
  plan_.compile();
  std::array<const Image*, 6> even{};
  for (std::size_t i = 0; i < images_.size(); ++i) even[i] = &plan_.get(images_[i]);
  plan_.execute();
  for (std::size_t i = 0; i < images_.size(); ++i) {
    EXPECT_EQ(&plan_.get(images_[i]) != even[i], i == 2) << i;
  }
}

TEST_F(OverlappingFramePlanTest, TheDeviceHasRoomForTheNextFrameBeforeTheEndOfOne) {
  plan_.compile();
  EXPECT_EQ(plan_.part_before_next(), 1.0f) << "no frame has begun";
  plan_.begin();
  EXPECT_EQ(plan_.part_before_next(), 1.0f) << "a frame with timers is alone";
  plan_.finish();
  plan_.begin();
  const float alone = plan_.part_before_next();
  plan_.begin();
  plan_.finish();
  const float beside = plan_.part_before_next();
  plan_.finish();
  if (device_.queues().compute_count() < 2) {
    EXPECT_EQ(alone, 1.0f) << "on one queue";
    EXPECT_EQ(beside, 1.0f);
    return;
  }
  EXPECT_GT(alone, 0.0f);
  EXPECT_LT(alone, 1.0f);
  EXPECT_LT(beside, alone) << "its start has run beside the frame before";
}

TEST_F(FramePlanTest, WhatIsIgnoredWhenSkippedDoesNotHoldUpTheNextFrame) {
  if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
  for (const bool ignored : {false, true}) {
    FramePlan plan(device_, {5, 3});
    const ImageRef zero = plan.image("zero", format);
    plan.get(zero).clear();
    plan.share_memory();
    const ImageRef maybe = plan.image("maybe", format), end = plan.image("end", format);
    if (ignored) plan.ignore_when_skipped(maybe);
    const auto add_to = [&](const char* name, ImageRef from, ImageRef to) {
      return plan.pass(name, program_).read(from).write(to).constants(1.0f).dispatch(plan.extent());
    };
    add_to("maybe", zero, maybe).when([] { return true; });
    add_to("end", maybe, end);
    plan.compile();
    const Image& even = plan.get(maybe);
    plan.execute();
    EXPECT_EQ(&plan.get(maybe) != &even, ignored) << "frames have their own in turn";
  }
}

// As debug views do while a reference takes over.
TEST_F(OverlappingFramePlanTest, WhatFramesLeaveOutIsLatestOfTheLastThatDidNot) {
  plan_.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    number_ = static_cast<float>(frame);
    plan_.execute();
  }
  runs_ = false;
  number_ = 0.0f;
  for (int frame = 0; frame < 3; ++frame) {
    plan_.execute();
    for (const ImageRef image : images_) EXPECT_EQ(value(image), 3.0f);
  }
}

TEST_F(FramePlanTest, FramesWithTimersAreNotOverlapped) {
  if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
  const auto a = image("a"), b = image("b");
  bool wanted = false;
  add("maybe", a, b).when([&] { return wanted; });
  add("always", a, image("c"));
  plan_.compile();
  plan_.execute();
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  int overlapped = 0;
  for (int frame = 0; frame < 40; ++frame) {
    plan_.begin();
    overlapped += plan_.can_begin_another();
    plan_.finish();
  }
  EXPECT_GE(overlapped, 36);
  EXPECT_LT(overlapped, 40) << "one of sixteen is timed";
  wanted = true;
  plan_.execute();
  const float measured = plan_.timings()[0].milliseconds;
  EXPECT_GT(measured, 0.0f);
  wanted = false;
  plan_.execute();
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  wanted = true;
  plan_.execute();
  EXPECT_EQ(plan_.timings()[0].milliseconds, measured) << "not timed again";
}

}  // namespace
}  // namespace heliograph::gpu
