#include "session/viewers/broadcast.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <utility>

#include "recording_link.hpp"

namespace heliograph::session {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Frames of which the device has encoded a JPEG, for one or two viewers.
class BroadcastTest : public testing::Test {
 protected:
  BroadcastTest() {
    session_ = std::make_shared<Session>(SessionOptions{}, wake_);
    broadcast_.emplace(session_, BroadcastServices{.encoder = worker_,
                                                   .jpeg = jpeg_,
                                                   .measurements = measurements_,
                                                   .wake = wake_,
                                                   .tracer = protocol::TracerKind::software,
                                                   .read_pixels = [this] {
                                                     ++pixels_read_;
                                                     return pixels_;
                                                   }});
  }
  ~BroadcastTest() override { worker_.stop(); }

  void join(const std::string& viewer, int quality) {
    links_.push_back(std::make_shared<test::RecordingLink>());
    ASSERT_TRUE(session_->viewers().join(viewer, links_.back()));
    session_->viewers().start(viewer);
    ASSERT_TRUE(session_->viewers().configure(viewer, {.quality = quality}));
  }
  void render(FramePurpose purpose = FramePurpose::interactive, std::uint32_t samples = 1,
              std::uint64_t start_us = 0) {
    auto frame = std::make_shared<RenderedFrame>();
    frame->frame.width = frame->frame.height = 16;
    frame->frame.jpeg = {
        .made = made_, .width = made_side_, .height = made_side_, .bytes = encoded_};
    frame->header.sample_count = samples;
    frame->header.render_start_us = start_us;
    broadcast_->rendered(std::move(frame), purpose);
  }
  /// The frame that the viewer is sent, once it is encoded.
  stream::SharedFrame sent(const std::string& viewer) {
    while (measurements_.totals().encodings.count() < due_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (int i = 0; i < 5000; ++i) {
      if (const auto taken = session_->viewers().take(viewer)) return taken->frame;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return nullptr;
  }
  bool pump(std::size_t encodings) {
    due_ += encodings;
    return broadcast_->pump();
  }
  /// As soon as the rate of the viewer allows it.
  bool pump_at_the_viewers_rate() {
    bool begun = pump(1);
    for (int i = 0; i < 5000 && !begun; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      begun = broadcast_->pump();
    }
    return begun;
  }

  const Bytes encoded_{1, 2, 3};
  render::JpegRequest made_{.quality = 80};
  std::uint32_t made_side_ = 16;
  Bytes pixels_ = Bytes(16 * 16 * 4, 128);
  int pixels_read_ = 0;
  std::size_t due_ = 0;
  const std::shared_ptr<WakeEvent> wake_ = std::make_shared<WakeEvent>();
  Worker worker_{"encoder", 1};
  stream::JpegEncoder jpeg_;
  Measurements measurements_;
  std::vector<std::shared_ptr<test::RecordingLink>> links_;
  std::shared_ptr<Session> session_;
  std::optional<Broadcast> broadcast_;
};

TEST_F(BroadcastTest, SendsJpegOfDeviceToViewersOfItsQuality) {
  join("a", 80);
  join("b", 80);
  EXPECT_EQ(session_->viewers().common_jpeg(FramePurpose::interactive),
            stream::EncodingVariant{.quality = 80});
  EXPECT_FALSE(session_->viewers().common_jpeg(FramePurpose::final));
  render();
  ASSERT_TRUE(pump(1));
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload, encoded_);
  EXPECT_EQ(frame->header.codec, protocol::FrameCodec::jpeg);
  EXPECT_EQ(frame->header.quality, 80);
  EXPECT_EQ(frame->header.width, 16);
  EXPECT_EQ(sent("b"), frame);
  EXPECT_EQ(pixels_read_, 0);
  EXPECT_EQ(measurements_.totals().encoded_by.at(protocol::PassKind::device), 1u);
}

TEST_F(BroadcastTest, ReadsPixelsForViewersOfOtherQualities) {
  join("a", 80);
  join("b", 40);
  EXPECT_FALSE(session_->viewers().common_jpeg(FramePurpose::interactive));
  render();
  ASSERT_TRUE(pump(2));
  EXPECT_EQ(pixels_read_, 1);
  ASSERT_TRUE(sent("b"));
  EXPECT_EQ(sent("a")->payload, encoded_);
  EXPECT_EQ(measurements_.totals().encoded_by.at(protocol::PassKind::host), 1u);
}

TEST_F(BroadcastTest, SendsJpegThatTheLinkWasGivenWhenTheFrameBegan) {
  join("a", 80);
  made_.quality = 68;
  render();
  ASSERT_TRUE(pump(1));
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload, encoded_);
  EXPECT_EQ(frame->header.quality, 68);
  EXPECT_EQ(pixels_read_, 0) << "the link's next choice is for the next frame";
}

TEST_F(BroadcastTest, SendsJpegThatTheDeviceHasMadeSmaller) {
  join("a", 80);
  made_ = {.quality = 56, .percent = 75};
  made_side_ = 12;
  render();
  ASSERT_TRUE(pump(1));
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload, encoded_);
  EXPECT_EQ(frame->header.width, 12);
  EXPECT_EQ(frame->header.height, 12);
  EXPECT_EQ(frame->variant.scale, 75) << "what the link is measured with";
  EXPECT_EQ(pixels_read_, 0);
}

TEST_F(BroadcastTest, EncodesAgainWhatNoLinkOfTheViewerIsGiven) {
  join("a", 80);
  made_.quality = 75;
  render();
  ASSERT_TRUE(pump(1));
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.quality, 80);
  EXPECT_EQ(pixels_read_, 1);
}

TEST_F(BroadcastTest, FramesOfAStaticImageAreWhole) {
  join("a", 80);
  made_ = {.quality = 56, .percent = 75};
  made_side_ = 12;
  render(FramePurpose::refining);
  ASSERT_TRUE(pump(1));
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.width, 16);
  EXPECT_EQ(pixels_read_, 1);
}

TEST_F(BroadcastTest, SendsRefiningFramesAgainAfterSomeSeconds) {
  join("a", 80);
  render(FramePurpose::refining, 64, 1'000'000);
  ASSERT_TRUE(pump(1));
  ASSERT_TRUE(sent("a"));
  ASSERT_TRUE(session_->viewers().acknowledge("a", {.frame_seq = 1}));
  render(FramePurpose::refining, 65, 4'900'000);
  EXPECT_FALSE(broadcast_->pump());
  render(FramePurpose::refining, 66, 5'000'000);
  ASSERT_TRUE(pump_at_the_viewers_rate());
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.sample_count, 66u);
}

TEST_F(BroadcastTest, EncodesFinalFrameFromPixels) {
  join("a", 80);
  render(FramePurpose::refining, 4);
  ASSERT_TRUE(pump(1));
  ASSERT_TRUE(sent("a"));
  ASSERT_TRUE(session_->viewers().acknowledge("a", {.frame_seq = 1}));
  // Not sent: its samples have not doubled. The final frame shows it.
  render(FramePurpose::refining, 5);
  broadcast_->send_final();
  ASSERT_TRUE(pump_at_the_viewers_rate());
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.sample_count, 5u);
  EXPECT_EQ(frame->header.quality, 95);
  EXPECT_EQ(pixels_read_, 1);
  EXPECT_TRUE(broadcast_->final_sent());
}

TEST_F(BroadcastTest, WaitsForNextFrameWherePixelsAreGone) {
  join("a", 40);
  pixels_.clear();
  render();
  EXPECT_FALSE(pump(0));
  EXPECT_FALSE(pump(0)) << "what is gone is not asked for again";
  EXPECT_EQ(pixels_read_, 1);
  ASSERT_TRUE(session_->viewers().configure("a", {.quality = 80}));
  render();
  ASSERT_TRUE(pump(1));
  EXPECT_EQ(sent("a")->payload, encoded_);
}

TEST_F(BroadcastTest, SendsTheFrameBehindOneWhosePixelsAreGone) {
  join("a", 40);
  render(FramePurpose::refining, 4);
  const Bytes pixels = std::exchange(pixels_, {});
  EXPECT_FALSE(pump(0));
  pixels_ = pixels;
  render(FramePurpose::refining, 5);
  ASSERT_TRUE(pump(1)) << "the viewer has none of this state, though samples have not doubled";
  const stream::SharedFrame frame = sent("a");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.sample_count, 5u);
}

}  // namespace
}  // namespace heliograph::session
