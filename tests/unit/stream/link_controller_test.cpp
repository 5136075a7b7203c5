#include "stream/pacing/link_controller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "stream/pacing/viewer_pacer.hpp"

namespace heliograph::stream {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A link of `rate` bytes per second, on which frames queue, with a round trip of `way`; a renderer
/// that makes a frame every `interval` while the viewer's window is open.
struct Link {
  double rate;
  microseconds way;
};

class LinkControllerTest : public testing::Test {
 protected:
  struct Sent {
    std::uint64_t bytes;
    EncodingVariant variant;
    Clock::time_point at;
    Clock::time_point back;
  };

  /// Advances the time; returns the frames of the last second.
  std::vector<Sent> run(const Link& link, seconds time, EncodingVariant requested = {},
                        microseconds interval = milliseconds(33)) {
    const Clock::time_point end = now_ + time;
    std::vector<Sent> last;
    while (now_ < end) {
      while (!in_flight_.empty() && in_flight_.front().back <= now_) {
        const Sent& sent = in_flight_.front();
        controller_.arrived({.bytes = sent.bytes,
                             .variant = sent.variant,
                             .delay = duration_cast<microseconds>(sent.back - sent.at),
                             .interval = interval},
                            now_);
        if (now_ > end - seconds(1)) last.push_back(sent);
        in_flight_.pop_front();
      }
      if (in_flight_.size() < ack_window && now_ >= next_frame_) {
        const EncodingVariant variant = controller_.choose(requested, pixels_);
        double bytes = whole_bytes_ * relative_bytes(variant);
        if (variant.codec == protocol::StreamCodec::h264) {
          bytes = std::min(0.2 * whole_bytes_, controller_.budget());
        }
        busy_until_ = std::max(busy_until_, now_) +
                      duration_cast<Clock::duration>(duration<double>(bytes / link.rate));
        in_flight_.push_back({.bytes = static_cast<std::uint64_t>(bytes),
                              .variant = variant,
                              .at = now_,
                              .back = busy_until_ + link.way});
        next_frame_ = now_ + interval;
      }
      now_ += milliseconds(1);
    }
    return last;
  }

  static double longest_delay_ms(const std::vector<Sent>& frames) {
    double longest = 0.0;
    for (const Sent& sent : frames) {
      longest = std::max(longest, duration<double, std::milli>(sent.back - sent.at).count());
    }
    return longest;
  }

  LinkController controller_;
  std::deque<Sent> in_flight_;
  Clock::time_point now_ = Clock::time_point() + std::chrono::hours(1);
  Clock::time_point next_frame_;
  Clock::time_point busy_until_;
  double whole_bytes_ = 100'000;
  std::uint64_t pixels_ = 1280 * 720;
};

const EncodingVariant whole{};

TEST_F(LinkControllerTest, AFastLinkChangesNothing) {
  const auto frames = run({.rate = 50e6, .way = milliseconds(2)}, seconds(10));
  EXPECT_EQ(controller_.choose(whole, pixels_), whole);
  EXPECT_GT(frames.size(), 28u);
}

TEST_F(LinkControllerTest, ALongRoundTripIsNotMistakenForASlowLink) {
  const auto frames = run({.rate = 50e6, .way = milliseconds(200)}, seconds(20));
  EXPECT_EQ(controller_.choose(whole, pixels_), whole);
  EXPECT_NEAR(static_cast<double>(controller_.base_delay().count()), 200e3, 15e3);
  EXPECT_GE(frames.size(), 8u) << "a window of two every 200 ms";
}

TEST_F(LinkControllerTest, ASlowLinkGetsSmallerFramesInTime) {
  const Link link{.rate = 1e6, .way = milliseconds(20)};
  const auto before = run(link, seconds(1));
  const auto frames = run(link, seconds(15));
  EXPECT_LT(longest_delay_ms(frames), 0.5 * longest_delay_ms(before));
  EXPECT_GT(frames.size(), 25u) << "every rendered frame";
  double bytes = 0.0;
  for (const Sent& sent : frames) bytes += static_cast<double>(sent.bytes);
  EXPECT_GT(bytes, 0.4 * link.rate) << "most of the link is used";
}

TEST_F(LinkControllerTest, AdaptsQuicklyToASlowerLinkAndBack) {
  run({.rate = 50e6, .way = milliseconds(10)}, seconds(5));
  run({.rate = 1e6, .way = milliseconds(10)}, seconds(4));
  EXPECT_LT(relative_bytes(controller_.choose(whole, pixels_)), 0.6);
  run({.rate = 50e6, .way = milliseconds(10)}, seconds(30));
  EXPECT_EQ(controller_.choose(whole, pixels_), whole);
}

TEST_F(LinkControllerTest, AFullQueueIsNotMistakenForALongRoundTrip) {
  // So slow that the smallest frames do not fit: always late.
  run({.rate = 60e3, .way = milliseconds(20)}, std::chrono::minutes(2));
  EXPECT_LT(controller_.base_delay(), milliseconds(120));
  EXPECT_LE(controller_.choose(whole, pixels_).scale, 50);
}

TEST_F(LinkControllerTest, ChangesAreRareOnceTheVariantHasSettled) {
  const Link link{.rate = 1.2e6, .way = milliseconds(15)};
  run(link, seconds(20));
  int changes = 0;
  EncodingVariant last = controller_.choose(whole, pixels_);
  for (int second = 0; second < 20; ++second) {
    run(link, seconds(1));
    const EncodingVariant form = controller_.choose(whole, pixels_);
    changes += form != last ? 1 : 0;
    last = form;
  }
  EXPECT_LE(changes, 8);
}

TEST_F(LinkControllerTest, AVideoGetsABudgetBeforeASmallerSize) {
  EncodingVariant video = whole;
  video.codec = protocol::StreamCodec::h264;
  run({.rate = 400e3, .way = milliseconds(20)}, seconds(10), video);
  EXPECT_LT(controller_.budget(), 20'000);
  EXPECT_GT(controller_.budget(), 4'000);
  EXPECT_EQ(controller_.choose(video, pixels_).scale, 100);
  EXPECT_NE(controller_.choose(video, pixels_), video) << "those on better ways must not share it";
}

TEST_F(LinkControllerTest, KnowsWhatItMayChoose) {
  EXPECT_TRUE(LinkController::may_choose(whole, whole));
  EXPECT_TRUE(LinkController::may_choose(whole, {.quality = 68}));
  EXPECT_TRUE(LinkController::may_choose(whole, {.scale = 75, .quality = 56}));
  EXPECT_FALSE(LinkController::may_choose(whole, {.quality = 75})) << "another viewer asked for it";
  EXPECT_FALSE(LinkController::may_choose(whole, {.quality = 90}));
  EXPECT_FALSE(LinkController::may_choose({.quality = 40}, whole));
  const EncodingVariant video{.codec = protocol::StreamCodec::h264};
  EXPECT_FALSE(LinkController::may_choose(video, whole));
  run({.rate = 60e3, .way = milliseconds(20)}, seconds(60));
  EXPECT_TRUE(LinkController::may_choose(whole, controller_.choose(whole, pixels_)));
}

TEST_F(LinkControllerTest, NeverExceedsTheRequestedVariant) {
  run({.rate = 500e3, .way = milliseconds(20)}, seconds(10));
  const EncodingVariant low{.quality = 8};
  EXPECT_LE(controller_.choose(low, pixels_).quality, 8);
}

}  // namespace
}  // namespace heliograph::stream
