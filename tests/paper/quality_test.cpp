#include "tests/paper/quality.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
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

TEST(Report, TablesShowTheMeanOfAllSeeds) {
  const std::vector<Measurement> measurements = {
      {"pillars", Swept::angle, 2.0f, Movement::still, "svgf", {0.90, 1.0, 0.5}, 1},
      {"pillars", Swept::angle, 2.0f, Movement::still, "svgf", {0.94, 1.0, 0.5}, 2}};
  const std::string text = quality_tables(measurements);
  EXPECT_NE(text.find("  svgf              0.9200"), std::string::npos) << text;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Report, FilesHaveARowPerSeedPassAndMoment) {
  Results results;
  results.measurements = {
      {"pillars", Swept::angle, 2.0f, Movement::still, "svgf", {0.5, 0.25, 1.5}, 7}};
  Timing timing;
  timing.scene = "pillars";
  timing.technique = "svgf";
  timing.slowest_fps = timing.mean_fps = timing.fastest_fps = 8.0;
  timing.passes = {{"compose", protocol::PassKind::device, 0.5f}};
  results.timings = {timing, timing};
  results.timings.back().value = 2.0f;
  results.moments = {{"pillars", "svgf", 2.0f, 3, 0.75}};
  const auto folder = std::filesystem::temp_directory_path() / "heliograph_report_test";
  write_files(folder, results, {{"size", "16x16"}});
  EXPECT_EQ(content_of(folder / "quality.csv"),
            "scene,swept,value,movement,preset,seed,ssim,flicker,luminance_ratio\n"
            "pillars,angle,2,static,svgf,7,0.5,1.5,0.25\n");
  EXPECT_EQ(content_of(folder / "timings.csv"),
            "scene,value,movement,preset,min_fps,avg_fps,max_fps\n"
            "pillars,,static,svgf,8,8,8\npillars,2,static,svgf,8,8,8\n");
  EXPECT_EQ(content_of(folder / "passes.csv"),
            "scene,value,movement,preset,pass,ms\n"
            "pillars,,static,svgf,compose,0.5\npillars,2,static,svgf,compose,0.5\n");
  EXPECT_EQ(content_of(folder / "over_time.csv"),
            "scene,value,preset,frame,ssim\npillars,2,svgf,3,0.75\n");
  const auto json = nlohmann::json::parse(content_of(folder / "experiments.json"));
  EXPECT_EQ(json["run"]["size"], "16x16");
  EXPECT_EQ(json["quality"][0]["seed"], 7);
  EXPECT_TRUE(json["timings"][0]["value"].is_null());
  std::filesystem::remove_all(folder);
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
