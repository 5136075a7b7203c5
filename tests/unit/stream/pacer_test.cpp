#include <gtest/gtest.h>

#include <memory>

#include "stream/pacing/viewer_pacer.hpp"

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

TEST_F(ViewerPacerTest, AStalledViewerHasOnePendingFrameAndGetsTheNewest) {
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

TEST_F(ViewerPacerTest, RefusesAcknowledgementsOfUnsentFrames) {
  EXPECT_FALSE(acknowledge(0));
  EXPECT_FALSE(acknowledge(7));
  pacer_.offer(frame(1));
  EXPECT_FALSE(acknowledge(1)) << "waiting, not sent";
  take();
  EXPECT_TRUE(acknowledge(1));
}

TEST_F(ViewerPacerTest, WhilePausedNothingIsPendingOrSent) {
  pacer_.offer(frame(1));
  pacer_.set_paused(true, now_);
  EXPECT_FALSE(pacer_.has_room(now_));
  pacer_.offer(frame(2));
  EXPECT_FALSE(take());
  pacer_.set_paused(false, now_);
  EXPECT_FALSE(take());
  pacer_.offer(frame(3));
  EXPECT_EQ(take()->frame->header.render_id, 3u);
}

TEST_F(ViewerPacerTest, OwesNoAcknowledgementWhilePaused) {
  EXPECT_FALSE(pacer_.unacknowledged_since(now_));
  pacer_.offer(frame(1));
  take();
  const auto sent = now_;
  now_ += milliseconds(5000);
  EXPECT_EQ(pacer_.unacknowledged_since(now_), sent);
  pacer_.set_paused(true, now_);
  now_ += milliseconds(60'000);
  EXPECT_EQ(pacer_.unacknowledged_since(now_), now_);
  pacer_.set_paused(false, now_);
  const auto resumed = now_;
  now_ += milliseconds(5000);
  EXPECT_EQ(pacer_.unacknowledged_since(now_), resumed) << "it has all its time again";
  EXPECT_TRUE(acknowledge(1));
  EXPECT_FALSE(pacer_.unacknowledged_since(now_));
}

TEST_F(ViewerPacerTest, RespectsTheMaximumFrameRate) {
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
  EXPECT_GT(pacer_.next_send(), now_ - milliseconds(100));
}

TEST_F(ViewerPacerTest, RoundTripExcludesTheClientsProcessing) {
  for (std::uint32_t id = 1; id <= 40; ++id) {
    pacer_.offer(frame(id));
    const auto taken = take();
    now_ += milliseconds(30);
    acknowledge(taken->frame_seq, milliseconds(10));
  }
  EXPECT_NEAR(static_cast<double>(pacer_.round_trip().count()), 20'000.0, 200.0);
  EXPECT_NEAR(pacer_.goodput(), 1000.0 / 0.030, 300.0);
}

TEST_F(ViewerPacerTest, HasRoomForTwoWhereThoseInFlightAreAcknowledgedByThen) {
  const milliseconds apart(5);
  EXPECT_TRUE(pacer_.has_room_for_two(now_, apart));
  pacer_.offer(frame(1));
  take();
  EXPECT_FALSE(pacer_.has_room_for_two(now_, apart)) << "how long that takes is not known";
  now_ += milliseconds(3);
  acknowledge(1, milliseconds(2));
  pacer_.offer(frame(2));
  take();
  EXPECT_TRUE(pacer_.has_room_for_two(now_, apart));
  EXPECT_FALSE(pacer_.has_room_for_two(now_, milliseconds(2))) << "its client's time counts, too";
  pacer_.offer(frame(3));
  take();
  EXPECT_FALSE(pacer_.has_room_for_two(now_, apart)) << "there is no room for one";
}

TEST_F(ViewerPacerTest, HasNoRoomForTwoWhereTheRateLimitHoldsTheSecondBack) {
  pacer_.set_max_rate(100.0);
  EXPECT_TRUE(pacer_.has_room_for_two(now_, milliseconds(10)));
  EXPECT_FALSE(pacer_.has_room_for_two(now_, milliseconds(9)));
}

TEST_F(ViewerPacerTest, LateMovingFramesLowerTheBudgetButStillsDoNot) {
  const auto send = [&](bool moving) {
    auto made = std::make_shared<EncodedFrame>();
    made->payload.resize(50'000);
    made->moving = moving;
    pacer_.offer(made);
    const auto taken = take();
    now_ += milliseconds(150);
    acknowledge(taken->frame_seq);
  };
  for (int i = 0; i < 20; ++i) send(false);
  EXPECT_EQ(pacer_.link().choose({}, 1280 * 720), EncodingVariant{});
  for (int i = 0; i < 8; ++i) send(true);
  EXPECT_LT(pacer_.link().budget(), 50'000);
}

TEST_F(ViewerPacerTest, AnImpossibleClientTimeDoesNotMakeTheRoundTripNegative) {
  pacer_.offer(frame(1));
  const auto taken = take();
  now_ += milliseconds(5);
  acknowledge(taken->frame_seq, std::chrono::hours(1));
  EXPECT_EQ(pacer_.round_trip().count(), 0);
}

SharedFrame video_frame(std::uint64_t video, std::uint32_t index) {
  auto made = std::make_shared<EncodedFrame>();
  made->variant.codec = protocol::StreamCodec::h264;
  made->video = VideoPosition{.video = video, .index = index};
  if (index == 0) made->header.flags = protocol::frame_flag::key;
  return made;
}

TEST_F(ViewerPacerTest, AVideoStartsAtAKeyFrameAndHasNoGaps) {
  EXPECT_FALSE(pacer_.can_show(*video_frame(1, 5))) << "the beginning is missing";
  pacer_.offer(video_frame(1, 0));
  EXPECT_FALSE(pacer_.can_show(*video_frame(1, 1))) << "it would replace the frame it needs";
  ASSERT_TRUE(take());
  EXPECT_TRUE(pacer_.can_show(*video_frame(1, 1)));
  EXPECT_FALSE(pacer_.can_show(*video_frame(1, 2)));
  EXPECT_FALSE(pacer_.can_show(*video_frame(2, 1))) << "of another video";
  EXPECT_TRUE(pacer_.can_show(*video_frame(2, 0)));
  pacer_.offer(video_frame(1, 1));
  EXPECT_TRUE(pacer_.can_show(*frame(3)));
}

TEST_F(ViewerPacerTest, ReplacingAPendingVideoFrameBreaksTheVideo) {
  pacer_.offer(video_frame(1, 0));
  pacer_.offer(frame(2));
  ASSERT_TRUE(take());
  EXPECT_FALSE(pacer_.decoder());
  EXPECT_FALSE(pacer_.can_show(*video_frame(1, 1)));
}

TEST_F(ViewerPacerTest, AnIndependentFrameDoesNotBreakTheVideo) {
  pacer_.offer(video_frame(1, 0));
  ASSERT_TRUE(take());
  pacer_.offer(frame(2));
  ASSERT_TRUE(take());
  EXPECT_TRUE(pacer_.can_show(*video_frame(1, 1)));
}

TEST_F(ViewerPacerTest, ASkippedFrameCountsAsDropped) {
  pacer_.offer(frame(1));
  EXPECT_EQ(take()->frame_seq, 1u);
  acknowledge(1);
  pacer_.skip();
  pacer_.offer(frame(3));
  const auto next = take();
  EXPECT_EQ(next->frame_seq, 3u);
  EXPECT_TRUE(next->first_after_drop);
  EXPECT_EQ(pacer_.totals().dropped, 1u);
}

}  // namespace
}  // namespace heliograph::stream
