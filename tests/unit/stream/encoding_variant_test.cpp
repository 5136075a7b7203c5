#include <gtest/gtest.h>

#include "stream/pacing/variant_planner.hpp"

namespace heliograph::stream {
namespace {

using protocol::StreamCodec;
using std::chrono::milliseconds;

EncodingVariant jpeg(int quality, int scale = 100) {
  return {.codec = StreamCodec::jpeg, .scale = scale, .quality = quality};
}

EncodingVariant video(int quality, int scale = 100) {
  return {.codec = StreamCodec::h264, .scale = scale, .quality = quality};
}

TEST(ReduceVariants, KeepsTheExtremesWithinTheMaximum) {
  EXPECT_EQ(reduce_variants({jpeg(80), jpeg(80), jpeg(60)}),
            (std::vector<EncodingVariant>{jpeg(60), jpeg(80)}));
  EXPECT_EQ(reduce_variants({jpeg(10), jpeg(90), jpeg(50), jpeg(70), jpeg(30)}),
            (std::vector<EncodingVariant>{jpeg(10), jpeg(50), jpeg(90)}));
  EXPECT_TRUE(reduce_variants({}).empty());
}

TEST(ReduceVariants, KeepsOneJpegAmongVideos) {
  const auto variants = reduce_variants({video(80), video(60), video(70), jpeg(80), jpeg(50)});
  EXPECT_EQ(variants.size(), max_variants);
  EXPECT_EQ(assigned_variant(variants, jpeg(80)), jpeg(50));
  EXPECT_EQ(assigned_variant(variants, video(70)), video(60));
  EXPECT_EQ(assigned_variant(variants, video(80)), video(80));
}

TEST(AssignedVariant, IsNoMoreExpensiveThanRequestedIfPossible) {
  const std::vector<EncodingVariant> variants{jpeg(10), jpeg(50), jpeg(90)};
  EXPECT_EQ(assigned_variant(variants, jpeg(10)), jpeg(10));
  EXPECT_EQ(assigned_variant(variants, jpeg(89)), jpeg(50));
  EXPECT_EQ(assigned_variant(variants, jpeg(100)), jpeg(90));
  EXPECT_EQ(assigned_variant({jpeg(95)}, jpeg(1)), jpeg(95));
}

TEST(RelativeBytes, DecreaseWithScaleAndQuality) {
  EXPECT_LT(relative_bytes(jpeg(70)), relative_bytes(jpeg(80)));
  EXPECT_LT(relative_bytes(jpeg(80, 50)), relative_bytes(jpeg(80, 75)));
  EXPECT_DOUBLE_EQ(relative_bytes(jpeg(80)), 1.0);
}

class VariantPlannerTest : public testing::Test {
 protected:
  /// Encodes the requested video frame at the next position.
  VideoPosition encode(const VariantRequest& request) {
    if (request.key || !running_)
      newest_ = {.video = newest_.video + 1, .index = 0};
    else
      ++newest_.index;
    running_ = true;
    EncodedFrame frame;
    frame.variant = request.variant;
    frame.video = newest_;
    if (newest_.index == 0) frame.header.flags = protocol::frame_flag::key;
    planner_.published(frame, now_);
    return newest_;
  }
  VariantPlanner::Plan plan(std::vector<RequestedVariant> requests) {
    return planner_.plan(requests, now_);
  }

  VariantPlanner planner_;
  VideoPosition newest_;
  bool running_ = false;
  Clock::time_point now_ = Clock::time_point() + std::chrono::hours(1);
};

TEST_F(VariantPlannerTest, EncodesOnlyForReadyViewers) {
  const auto some = plan({{.variant = jpeg(80), .ready = true}, {.variant = jpeg(40)}});
  ASSERT_EQ(some.requests.size(), 1u);
  EXPECT_EQ(some.requests[0].variant, jpeg(80));
  EXPECT_EQ(some.assigned[1], jpeg(40)) << "kept for when it is ready";
  EXPECT_TRUE(plan({{.variant = jpeg(80)}}).requests.empty());
}

TEST_F(VariantPlannerTest, TheFirstViewerOfAVideoGetsAKeyFrameAtOnce) {
  const auto first = plan({{.variant = video(80), .ready = true}});
  ASSERT_EQ(first.requests.size(), 1u);
  EXPECT_TRUE(first.requests[0].key);
  const VideoPosition at = encode(first.requests[0]);
  const auto next = plan({{.variant = video(80), .ready = true, .decoder = at}});
  ASSERT_EQ(next.requests.size(), 1u);
  EXPECT_FALSE(next.requests[0].key);
}

TEST_F(VariantPlannerTest, NewViewersGetJpegsUntilAKeyFrameIsAllowed) {
  const VideoPosition at = encode({.variant = video(80), .key = true});
  now_ += milliseconds(100);
  const RequestedVariant old{.variant = video(80), .ready = true, .decoder = at};
  const RequestedVariant new_viewer{.variant = video(80), .ready = true};
  const auto soon = plan({old, new_viewer});
  ASSERT_EQ(soon.requests.size(), 2u);
  EXPECT_EQ(soon.requests[0].variant, video(80));
  EXPECT_FALSE(soon.requests[0].key) << "it must not cost the other viewer";
  EXPECT_EQ(soon.requests[1].variant, VariantPlanner::jpeg_fallback(video(80)));
  now_ += VariantPlanner::min_key_interval;
  const auto later = plan({old, new_viewer});
  ASSERT_EQ(later.requests.size(), 1u);
  EXPECT_TRUE(later.requests[0].key);
}

TEST_F(VariantPlannerTest, KeyFrameComesAtOnceIfNoViewerCanContinue) {
  const VideoPosition lost = encode({.variant = video(80), .key = true});
  encode({.variant = video(80)});
  encode({.variant = video(80)});
  const auto again = plan({{.variant = video(80), .ready = true, .decoder = lost}});
  ASSERT_EQ(again.requests.size(), 1u);
  EXPECT_TRUE(again.requests[0].key);
}

TEST_F(VariantPlannerTest, AVideoPausesWhileItsOnlyViewerHasAFullWindow) {
  const VideoPosition at = encode({.variant = video(80), .key = true});
  const auto plan_for_new_viewer =
      plan({{.variant = video(80), .decoder = at}, {.variant = video(80), .ready = true}});
  ASSERT_EQ(plan_for_new_viewer.requests.size(), 1u);
  EXPECT_EQ(plan_for_new_viewer.requests[0].variant.codec, StreamCodec::jpeg)
      << "the viewer with a full window would miss this frame";
}

}  // namespace
}  // namespace heliograph::stream
