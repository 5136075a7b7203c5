#include "tests/paper/quality.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/paper/report.hpp"

namespace heliograph::paper {
namespace {

render::Frame make_frame(std::uint8_t level, std::uint8_t step) {
  render::Frame frame;
  frame.width = frame.height = 16;
  for (std::uint32_t i = 0; i < frame.width * frame.height; ++i) {
    const auto value = static_cast<std::uint8_t>(level + step * (i % 3));
    frame.rgba.insert(frame.rgba.end(), {value, value, value, 255});
  }
  return frame;
}

TEST(Quality, GroundTruthIsPerfect) {
  const std::vector<render::Frame> ground_truth(3, make_frame(90, 20));
  const Quality quality = compare(ground_truth, ground_truth);
  EXPECT_NEAR(quality.ssim, 1.0, 1e-12);
  EXPECT_EQ(quality.luminance_ratio, 1.0);
  EXPECT_EQ(quality.flicker, 0.0);
}

TEST(Quality, GroundTruthMotionIsNoFlicker) {
  const std::vector<render::Frame> ground_truth = {make_frame(40, 10), make_frame(80, 10),
                                                   make_frame(120, 10)};
  EXPECT_EQ(compare(ground_truth, ground_truth).flicker, 0.0);
  const std::vector<render::Frame> frozen(3, make_frame(40, 10));
  EXPECT_EQ(compare(frozen, ground_truth).flicker, 40.0);
}

TEST(Quality, ConstantErrorLowersSsimWithoutFlicker) {
  const std::vector<render::Frame> ground_truth(2, make_frame(90, 20));
  const std::vector<render::Frame> darker(2, make_frame(60, 20));
  const Quality quality = compare(darker, ground_truth);
  EXPECT_LT(quality.ssim, 0.99);
  EXPECT_EQ(quality.flicker, 0.0);
  EXPECT_LT(quality.luminance_ratio, 0.8);
}

TEST(Quality, LuminanceIsLinear) {
  render::Frame grey = make_frame(188, 0);  // sRGB 188 is half of the light of white
  EXPECT_NEAR(displayed_luminance(grey), 0.5, 0.01);
}

TEST(Quality, SingleFrameIsRejected) {
  const std::vector<render::Frame> one(1, make_frame(90, 20));
  EXPECT_THROW(compare(one, one), std::invalid_argument);
}

TEST(Report, HasRowPerTechniqueAndColumnPerValue) {
  const std::vector<Measurement> measurements = {
      {"pillars", Swept::angle, 2.0f, Movement::still, "svgf", {0.91, 1.0, 0.5}},
      {"pillars", Swept::angle, 10.0f, Movement::still, "svgf", {0.82, 1.0, 0.5}},
      {"pillars", Swept::angle, 2.0f, Movement::still, "best", {0.95, 1.0, 0.5}}};
  const std::string text = quality_tables(measurements);
  EXPECT_NE(text.find("pillars, static, by angle"), std::string::npos);
  EXPECT_NE(text.find("  svgf              0.9100   0.8200"), std::string::npos) << text;
  EXPECT_NE(text.find("  best              0.9500   -"), std::string::npos) << text;
}

TEST(Report, FrameRatesExcludeWarmUp) {
  std::vector<render::Frame> frames(4);
  const float milliseconds[] = {500.0f, 10.0f, 20.0f, 30.0f};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].milliseconds = milliseconds[i];
    frames[i].passes = {{"gbuffer", protocol::PassKind::device, 0.5f * milliseconds[i]}};
  }
  const Timing timing = summarise(frames, 1);
  EXPECT_NEAR(timing.fastest_fps, 100.0, 1e-3);
  EXPECT_NEAR(timing.slowest_fps, 1000.0 / 30.0, 1e-3);
  EXPECT_NEAR(timing.mean_fps, 50.0, 1e-3);
  ASSERT_EQ(timing.passes.size(), 1u);
  EXPECT_NEAR(timing.passes[0].milliseconds, 10.0f, 1e-4f);
  EXPECT_THROW(summarise(frames, 4), std::invalid_argument);
}

}  // namespace
}  // namespace heliograph::paper
