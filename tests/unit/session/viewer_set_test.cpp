#include "session/viewers/viewer_set.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "recording_link.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using test::RecordingLink;

class ViewerSetTest : public testing::Test {
 protected:
  struct Joined {
    std::shared_ptr<RecordingLink> link = std::make_shared<RecordingLink>();
    std::string id;
  };
  Joined join() {
    Joined joined;
    joined.id = "v" + std::to_string(++joined_so_far_);
    EXPECT_TRUE(viewers_.join(joined.id, joined.link));
    viewers_.start(joined.id);
    return joined;
  }

  int joined_so_far_ = 0;
  WakeEvent on_capacity_;
  ViewerSet viewers_{2, on_capacity_};
};

/// A frame as the encoder makes it, without pixels.
std::shared_ptr<stream::EncodedFrame> encoded(std::uint32_t render_id,
                                              const stream::EncodingVariant& form) {
  auto frame = std::make_shared<stream::EncodedFrame>();
  frame->variant = form;
  frame->header.render_id = render_id;
  frame->header.quality = static_cast<std::uint16_t>(form.quality);
  frame->header.width = frame->header.full_width = 16;
  frame->header.height = frame->header.full_height = 16;
  frame->payload.resize(100);
  frame->encoded_at = Clock::now();
  return frame;
}

/// Plans, encodes and publishes frame `number`; gives the variants it was encoded in.
std::vector<stream::EncodingVariant> show(ViewerSet& viewers, std::uint32_t number,
                                          FramePurpose purpose = FramePurpose::interactive) {
  const EncodingPlan plan = viewers.plan(number, purpose, 16 * 16);
  std::vector<stream::EncodingVariant> forms;
  std::vector<stream::SharedFrame> frames;
  for (const stream::VariantRequest& request : plan.requests) {
    forms.push_back(request.variant);
    frames.push_back(encoded(number, request.variant));
  }
  for (const protocol::StillFormat format : plan.stills) {
    const bool lossless = format == protocol::StillFormat::png;
    auto frame = encoded(number, {.quality = lossless ? 100 : 95});
    if (lossless) frame->header.codec = protocol::FrameCodec::png;
    forms.push_back(frame->variant);
    frames.push_back(frame);
  }
  viewers.publish(number, purpose, frames);
  return forms;
}

TEST_F(ViewerSetTest, DepthFollowsTheHeaderOfViewersThatAskedForIt) {
  const Joined plain = join();
  const Joined deep = join();
  EXPECT_FALSE(viewers_.wants_depth());
  ASSERT_TRUE(viewers_.configure(deep.id, {.depth = true}));
  EXPECT_TRUE(viewers_.wants_depth());
  (void)viewers_.plan(1, FramePurpose::interactive, 16 * 16);
  const auto frame = encoded(1, {});
  frame->depth = std::make_shared<const std::vector<std::uint8_t>>(10, std::uint8_t{7});
  viewers_.publish(1, FramePurpose::interactive, {frame});

  const auto without = viewers_.take(plain.id);
  EXPECT_EQ(without->header.size(), 64u);
  EXPECT_FALSE(protocol::decode_frame_header(without->header)->flags & protocol::frame_flag::depth);
  const auto with = viewers_.take(deep.id);
  ASSERT_EQ(with->header.size(), 74u);
  EXPECT_EQ(with->header.back(), 7);
  const auto header = protocol::decode_frame_header(with->header);
  EXPECT_EQ(header->header_bytes, 74);
  EXPECT_TRUE(header->flags & protocol::frame_flag::depth);
  ASSERT_TRUE(viewers_.configure(deep.id, {.paused = true}));
  EXPECT_FALSE(viewers_.wants_depth());
}

TEST_F(ViewerSetTest, RefusesMoreViewersThanItsLimit) {
  const Joined first = join();
  const Joined second = join();
  const auto third = viewers_.join("third", std::make_shared<RecordingLink>());
  EXPECT_EQ(third.error().code, ErrorCode::full);
  viewers_.leave(first.id);
  EXPECT_TRUE(viewers_.join("third", std::make_shared<RecordingLink>()));
}

TEST_F(ViewerSetTest, EncodesPerQualityAndSharesTheFinalFrame) {
  const Joined first = join();
  const Joined second = join();
  ASSERT_TRUE(viewers_.configure(first.id, {.quality = 40}));
  EXPECT_EQ(show(viewers_, 7),
            (std::vector<stream::EncodingVariant>{{.quality = 40}, {.quality = 80}}));
  const auto low = viewers_.take(first.id);
  const auto high = viewers_.take(second.id);
  ASSERT_TRUE(low && high);
  EXPECT_EQ(protocol::decode_frame_header(low->header)->quality, 40);
  EXPECT_EQ(protocol::decode_frame_header(low->header)->frame_seq, 1u);
  EXPECT_EQ(protocol::decode_frame_header(high->header)->quality, 80);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(show(viewers_, 8, FramePurpose::final),
            (std::vector<stream::EncodingVariant>{{.quality = 95}}));
  EXPECT_EQ(viewers_.take(first.id)->frame, viewers_.take(second.id)->frame);
}

TEST_F(ViewerSetTest, SendsTheFinalFrameAsPngWhereRequested) {
  const Joined first = join();
  const Joined second = join();
  const auto state = viewers_.configure(second.id, {.still = protocol::StillFormat::png});
  EXPECT_EQ(state->still, protocol::StillFormat::png);
  EXPECT_EQ(show(viewers_, 1, FramePurpose::final).size(), 2u);
  EXPECT_EQ(viewers_.take(first.id)->frame->header.codec, protocol::FrameCodec::jpeg);
  EXPECT_EQ(viewers_.take(second.id)->frame->header.codec, protocol::FrameCodec::png);
}

TEST_F(ViewerSetTest, RefusesAVideoCodecThatHelloDidNotAgreeOn) {
  const Joined viewer = join();
  const auto refused = viewers_.configure(viewer.id, {.codec = protocol::StreamCodec::h264});
  EXPECT_EQ(refused.error().path, "codec");
}

TEST_F(ViewerSetTest, OffersTheLatestFrameToNewViewers) {
  const Joined first = join();
  show(viewers_, 3, FramePurpose::final);
  const Joined viewer = join();
  EXPECT_GT(viewer.link->announced, 0);
  EXPECT_EQ(viewers_.take(viewer.id)->frame->header.render_id, 3u);
  EXPECT_FALSE(viewers_.needs_frame(3));
}

TEST_F(ViewerSetTest, EncodesTheLatestFrameAgainForAnotherVariant) {
  const Joined first = join();
  show(viewers_, 3);
  ASSERT_TRUE(viewers_.take(first.id));
  const Joined viewer = join();
  ASSERT_TRUE(viewers_.configure(viewer.id, {.quality = 40, .paused = true}));
  ASSERT_TRUE(viewers_.configure(viewer.id, {.paused = false}));
  EXPECT_TRUE(viewers_.needs_frame(3));
  EXPECT_EQ(show(viewers_, 3), (std::vector<stream::EncodingVariant>{{.quality = 40}}));
  EXPECT_EQ(viewers_.take(viewer.id)->frame->header.quality, 40);
  EXPECT_FALSE(viewers_.take(first.id)) << "it has this frame";
}

TEST_F(ViewerSetTest, DoesNotSendAFrameTwiceWhenAViewerJoins) {
  const Joined first = join();
  show(viewers_, 1, FramePurpose::final);
  ASSERT_TRUE(viewers_.take(first.id));
  const Joined second = join();
  ASSERT_TRUE(viewers_.configure(second.id, {.still = protocol::StillFormat::png}));
  EXPECT_TRUE(viewers_.needs_frame(1));
  show(viewers_, 1, FramePurpose::final);
  EXPECT_FALSE(viewers_.take(first.id));
  EXPECT_EQ(viewers_.take(second.id)->frame->header.codec, protocol::FrameCodec::png);
}

TEST_F(ViewerSetTest, PausedViewersGetNothingAndResumeWithTheLatestFrame) {
  const Joined other = join();
  const Joined viewer = join();
  ASSERT_TRUE(viewers_.configure(viewer.id, {.paused = true}));
  show(viewers_, 4);
  EXPECT_FALSE(viewers_.take(viewer.id));
  ASSERT_TRUE(viewers_.configure(viewer.id, {.paused = false}));
  EXPECT_EQ(viewers_.take(viewer.id)->frame->header.render_id, 4u);
  viewers_.leave(other.id);
  ASSERT_TRUE(viewers_.configure(viewer.id, {.paused = true}));
  EXPECT_FALSE(viewers_.has_active_viewer());
}

TEST_F(ViewerSetTest, AcceptsFramesWhileTheAckWindowIsOpen) {
  EXPECT_FALSE(viewers_.can_accept_frame()) << "no viewers";
  const Joined viewer = join();
  ASSERT_TRUE(viewers_.configure(viewer.id, {.max_fps = 240.0}));
  for (std::uint32_t id = 1; id <= stream::ack_window; ++id) {
    show(viewers_, id);
    ASSERT_TRUE(viewers_.take(viewer.id));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(viewers_.can_accept_frame());
  EXPECT_TRUE(show(viewers_, 3).empty()) << "encoded without a viewer";
  ASSERT_TRUE(viewers_.acknowledge(viewer.id, {.frame_seq = 1}));
  EXPECT_TRUE(viewers_.can_accept_frame());
  EXPECT_TRUE(viewers_.needs_frame(3));
  EXPECT_EQ(show(viewers_, 3).size(), 1u);
}

TEST_F(ViewerSetTest, AsksForTheJpegThatAllLinksAreGiven) {
  EXPECT_FALSE(viewers_.common_jpeg(FramePurpose::interactive)) << "no viewers";
  const Joined slow = join();
  ASSERT_TRUE(viewers_.configure(slow.id, {.max_fps = 240.0}));
  const stream::EncodingVariant whole{};
  EXPECT_EQ(viewers_.common_jpeg(FramePurpose::interactive), whole);
  std::uint32_t number = 0;
  while (viewers_.common_jpeg(FramePurpose::interactive) == whole) {
    ASSERT_LT(++number, 60u) << "frames that are late are not made smaller";
    (void)viewers_.plan(number, FramePurpose::interactive, 16 * 16, whole);
    const auto frame = encoded(number, whole);
    frame->moving = true;
    frame->payload.resize(50'000);
    viewers_.publish(number, FramePurpose::interactive, {frame});
    ASSERT_TRUE(viewers_.take(slow.id));
    std::this_thread::sleep_for(std::chrono::milliseconds(35));
    ASSERT_TRUE(viewers_.acknowledge(slow.id, {.frame_seq = number}));
  }
  const auto less = viewers_.common_jpeg(FramePurpose::interactive);
  ASSERT_TRUE(less);
  EXPECT_LT(stream::relative_bytes(*less), stream::relative_bytes(whole));
  EXPECT_FALSE(viewers_.common_jpeg(FramePurpose::final));
  const Joined fast = join();
  EXPECT_FALSE(viewers_.common_jpeg(FramePurpose::interactive)) << "of two links";
}

TEST_F(ViewerSetTest, KeepsTheTotalsOfViewersThatLeft) {
  Joined viewer = join();
  show(viewers_, 1);
  ASSERT_TRUE(viewers_.take(viewer.id));
  viewers_.leave(viewer.id);
  viewer.link.reset();
  show(viewers_, 2);
  EXPECT_FALSE(viewers_.take(viewer.id));
  EXPECT_EQ(viewers_.acknowledge(viewer.id, {.frame_seq = 1}).error().code, ErrorCode::not_ready);
  EXPECT_EQ(viewers_.totals().viewers, 0u);
  EXPECT_EQ(viewers_.totals().sent.frames, 1u);
}

TEST_F(ViewerSetTest, SendsStatsAtTheSubscribedInterval) {
  const Joined viewer = join();
  ASSERT_TRUE(viewers_.subscribe(viewer.id, std::chrono::hours(1)));
  viewers_.publish_stats({.render_id = 4});
  EXPECT_TRUE(viewer.link->messages.empty()) << "no frame was sent to it";
  show(viewers_, 5);
  for (int i = 0; i < 3; ++i) viewers_.publish_stats({.render_id = 5});
  ASSERT_EQ(viewer.link->messages.size(), 1u);
  EXPECT_EQ(viewer.link->messages[0]["params"]["render_id"], 5);
  viewers_.publish_stats({.state = protocol::StreamPhase::idle});
  ASSERT_EQ(viewer.link->messages.size(), 2u) << "the final state is always sent";
  EXPECT_EQ(viewer.link->messages[1]["params"]["state"], "idle");
}

}  // namespace
}  // namespace heliograph::session
