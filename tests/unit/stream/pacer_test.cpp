#include <gtest/gtest.h>

#include <memory>

#include "stream/quality_classes.hpp"
#include "stream/viewer_pacer.hpp"

namespace heliograph::stream {
namespace {

using std::chrono::milliseconds;

class ViewerPacerTest : public testing::Test {
 protected:
  SharedFrame frame(std::uint32_t render_id, std::size_t bytes = 936) {
    auto made = std::make_shared<EncodedFrame>();
    made->header.render_id = render_id;
    made->payload.resize(bytes);
    return made;
  }
  std::optional<ViewerPacer::Taken> take() { return pacer_.take(now_); }
  bool acknowledge(std::uint32_t seq, milliseconds held = milliseconds(0)) {
    return pacer_.acknowledge(seq, held, now_);
  }

  ViewerPacer pacer_;
  Clock::time_point now_ = Clock::time_point() + std::chrono::hours(1);
};

TEST_F(ViewerPacerTest, SendsAWindowAheadOfTheAcknowledgements) {
  for (std::uint32_t id = 1; id <= ack_window; ++id) {
    EXPECT_TRUE(pacer_.has_room(now_));
    pacer_.offer(frame(id));
    ASSERT_TRUE(take());
  }
  EXPECT_FALSE(pacer_.has_room(now_));
  pacer_.offer(frame(3));
  EXPECT_FALSE(take()) << "the window is full";
  EXPECT_TRUE(acknowledge(1));
  EXPECT_EQ(take()->frame->header.render_id, 3u);
}

TEST_F(ViewerPacerTest, AStalledViewerKeepsOneWaitingFrameAndGetsTheNewest) {
  std::weak_ptr<const EncodedFrame> old;
  for (std::uint32_t id = 1; id <= 1000; ++id) {
    SharedFrame made = frame(id);
    if (id == 500) old = made;
    pacer_.offer(std::move(made));
    take();
  }
  EXPECT_TRUE(old.expired()) << "a dropped frame is still held";
  EXPECT_EQ(pacer_.totals().frames, ack_window);
  EXPECT_EQ(pacer_.totals().dropped, 1000 - ack_window - 1);

  EXPECT_TRUE(acknowledge(2));
  const auto next = take();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->frame->header.render_id, 1000u);
  EXPECT_EQ(next->frame_seq, 1000u) << "gaps in the numbers show the drops";
  EXPECT_TRUE(next->first_after_drop);
  pacer_.offer(frame(1001));
  EXPECT_FALSE(take()->first_after_drop);
}

TEST_F(ViewerPacerTest, AnAcknowledgementCoversEarlierFrames) {
  pacer_.offer(frame(1));
  take();
  pacer_.offer(frame(2));
  take();
  EXPECT_TRUE(acknowledge(2));
  EXPECT_FALSE(acknowledge(1)) << "out of order: already covered";
  EXPECT_FALSE(acknowledge(2)) << "twice";
  for (std::uint32_t id = 3; id <= 4; ++id) {
    pacer_.offer(frame(id));
    EXPECT_TRUE(take());
  }
  EXPECT_FALSE(pacer_.has_room(now_)) << "doubled acknowledgements must not widen the window";
}

TEST_F(ViewerPacerTest, IgnoresAcknowledgementsOfWhatWasNeverSent) {
  EXPECT_FALSE(acknowledge(0));
  EXPECT_FALSE(acknowledge(7));
  pacer_.offer(frame(1));
  EXPECT_FALSE(acknowledge(1)) << "waiting, not sent";
  take();
  EXPECT_TRUE(acknowledge(1));
}

TEST_F(ViewerPacerTest, WhilePausedNothingIsKeptOrSent) {
  pacer_.offer(frame(1));
  pacer_.set_paused(true);
  EXPECT_FALSE(pacer_.has_room(now_));
  pacer_.offer(frame(2));
  EXPECT_FALSE(take());
  pacer_.set_paused(false);
  EXPECT_FALSE(take());
  pacer_.offer(frame(3));
  EXPECT_EQ(take()->frame->header.render_id, 3u);
}

TEST_F(ViewerPacerTest, KeepsToTheMostFramesInASecond) {
  pacer_.set_max_rate(10.0);
  int sent = 0;
  for (int millisecond = 0; millisecond < 5000; millisecond += 7) {
    pacer_.offer(frame(static_cast<std::uint32_t>(millisecond)));
    if (const auto taken = take()) {
      ++sent;
      acknowledge(taken->frame_seq);
    }
    now_ += milliseconds(7);
  }
  EXPECT_NEAR(sent, 50, 2);
  EXPECT_GT(pacer_.next_turn(), now_ - milliseconds(100));
}

TEST_F(ViewerPacerTest, MeasuresTheWayWithoutTheClientsOwnTime) {
  for (std::uint32_t id = 1; id <= 40; ++id) {
    pacer_.offer(frame(id));
    const auto taken = take();
    now_ += milliseconds(30);
    acknowledge(taken->frame_seq, milliseconds(10));
  }
  EXPECT_NEAR(static_cast<double>(pacer_.round_trip().count()), 20'000.0, 200.0);
  EXPECT_NEAR(pacer_.goodput(), 1000.0 / 0.030, 300.0);
}

TEST_F(ViewerPacerTest, AnImpossibleClientTimeDoesNotMakeTheWayNegative) {
  pacer_.offer(frame(1));
  const auto taken = take();
  now_ += milliseconds(5);
  acknowledge(taken->frame_seq, std::chrono::hours(1));
  EXPECT_EQ(pacer_.round_trip().count(), 0);
}

TEST(QualityClasses, AreFewAndHoldTheExtremes) {
  EXPECT_EQ(quality_classes({80, 80, 60}), (std::vector<int>{60, 80}));
  EXPECT_EQ(quality_classes({10, 90, 50, 70, 30}), (std::vector<int>{10, 50, 90}));
  EXPECT_TRUE(quality_classes({}).empty());
}

TEST(QualityClasses, ViewersGetTheNearest) {
  EXPECT_EQ(nearest_class({10, 50, 90}, 10), 0u);
  EXPECT_EQ(nearest_class({10, 50, 90}, 62), 1u);
  EXPECT_EQ(nearest_class({10, 50, 90}, 70), 1u) << "of two equally near the cheaper one";
  EXPECT_EQ(nearest_class({95}, 1), 0u);
}

}  // namespace
}  // namespace heliograph::stream
