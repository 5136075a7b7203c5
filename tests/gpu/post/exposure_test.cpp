#include "render/passes/post/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "shaders/shared/exposure.h"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{38, 21};
constexpr std::size_t pixels = extent.width * extent.height;
using Texels = std::vector<glm::vec4>;

protocol::Settings automatic(float adaptation) {
  protocol::Settings settings;
  settings.exposure.mode = protocol::ExposureMode::automatic;
  settings.exposure.adaptation = adaptation;
  return settings;
}

class Meter {
 public:
  explicit Meter(const protocol::Settings& settings)
      : rig_(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}),
             {.extent = extent, .settings = settings}),
        hdr_(rig_.input("hdr", VK_FORMAT_R32G32B32A32_SFLOAT, Texels(pixels))),
        exposure_(render::expose(rig_.plan(), rig_.inputs(), hdr_, hdr_)) {}

  shared::ExposureState frame(const Texels& image, float seconds = 1.0f / 60.0f) {
    rig_.fill(hdr_, image);
    rig_.set_seconds(seconds);
    rig_.run();
    rig_.set_view(look({0, 0, 3}, {0, 0, 0}));  // later frames have a history
    shared::ExposureState state;
    std::memcpy(&state, rig_.plan().get(exposure_.report).mapped(), sizeof state);
    return state;
  }
  shared::ExposureState frame(float grey, float seconds = 1.0f / 60.0f) {
    return frame(Texels(pixels, glm::vec4(glm::vec3(grey), 1)), seconds);
  }
  void apply(const protocol::Settings& settings) {
    rig_.set_settings(settings);
    rig_.set_view(look({0, 0, 3}, {0, 0, 0}));
  }
  bool settled() { return render::is_settled(rig_.plan(), exposure_); }

 private:
  FrameRig rig_;
  gpu::ImageRef hdr_;
  render::Exposure exposure_;
};

TEST(Exposure, ManualIsCompensationOnly) {
  protocol::Settings settings;
  settings.exposure.compensation = -3.0f;
  Meter meter(settings);
  EXPECT_FLOAT_EQ(meter.frame(700.0f).factor, 0.125f);
  EXPECT_TRUE(meter.settled());
}

TEST(Exposure, AutomaticMapsUniformImageToMiddleGrey) {
  for (const float grey : {0.002f, 0.18f, 1.0f, 37.0f, 20000.0f}) {
    Meter meter(automatic(0.6f));
    EXPECT_NEAR(meter.frame(grey).factor * grey, 0.18f, 0.002f) << grey;
    EXPECT_TRUE(meter.settled()) << "the first frame needs no adaptation";
  }
}

TEST(Exposure, CompensationScalesAutomaticExposure) {
  protocol::Settings settings = automatic(0.6f);
  settings.exposure.compensation = 2.0f;
  Meter meter(settings);
  EXPECT_NEAR(meter.frame(5.0f).factor * 5.0f, 0.72f, 0.01f);
}

TEST(Exposure, MetersLogMeanIgnoringBlackAndBrightOutliers) {
  Meter meter(automatic(0.0f));
  Texels image(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t row = i / extent.width;
    image[i] = glm::vec4(glm::vec3(row % 4 == 0 ? 4.0f : 1.0f), 1);  // half of the metered rows
  }
  EXPECT_NEAR(meter.frame(image).factor, 0.18f / std::sqrt(4.0f), 0.01f);
  image.assign(pixels, glm::vec4(1, 1, 1, 1));
  for (std::size_t i = 0; i < pixels / 4; ++i) image[i] = glm::vec4(0, 0, 0, 1);
  for (std::size_t i = pixels / 2; i < pixels / 2 + 12; ++i) image[i] = glm::vec4(9e5f);
  EXPECT_NEAR(meter.frame(image).factor, 0.18f, 0.004f);
}

TEST(Exposure, IsClampedAndKeptWhereImageIsBlack) {
  Meter meter(automatic(0.0f));
  EXPECT_NEAR(std::log2(meter.frame(0.0003f).factor), shared::exposure_highest, 1e-4);
  EXPECT_NEAR(std::log2(meter.frame(1e6f).factor), shared::exposure_lowest, 1.5);
  const float before = meter.frame(0.5f).factor;
  EXPECT_EQ(meter.frame(0.0f).factor, before) << "nothing to meter: unchanged";
}

/// Exposure change in stops `time` seconds after a luminance step from 1 to 8, in frames of
/// `seconds`.
float stops_after(float time, float seconds, float adaptation) {
  Meter meter(automatic(adaptation));
  const float start = meter.frame(1.0f).stops;
  shared::ExposureState state{};
  const int frames = static_cast<int>(std::lround(time / seconds));
  for (int i = 0; i < frames; ++i) state = meter.frame(8.0f, seconds);
  return state.stops - start;
}

TEST(Exposure, StepResponseHasTimeConstantAtAnyFrameRate) {
  for (const float seconds : {1.0f / 60.0f, 1.0f / 15.0f, 0.2f}) {
    EXPECT_NEAR(stops_after(0.6f, seconds, 0.6f), -3.0f * (1.0f - std::exp(-1.0f)), 0.02f)
        << seconds;
    EXPECT_NEAR(stops_after(0.6f, seconds, 2.0f), -3.0f * (1.0f - std::exp(-0.3f)), 0.02f)
        << seconds;
  }
  EXPECT_NEAR(stops_after(0.2f, 0.2f, 0.0f), -3.0f, 0.01f) << "0: immediate";
}

TEST(Exposure, ReportsSettledAfterStep) {
  Meter meter(automatic(0.1f));
  meter.frame(1.0f);
  meter.frame(8.0f);
  EXPECT_FALSE(meter.settled());
  int frames = 1;
  while (!meter.settled() && frames < 200) {
    meter.frame(8.0f);
    ++frames;
  }
  EXPECT_NEAR(frames / 60.0, 0.1 * std::log(3.0 / 0.01), 0.04);
}

TEST(Exposure, IsDeterministic) {
  Texels image(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    image[i] = glm::vec4(glm::vec3(std::exp2(static_cast<float>(i % 23) - 9.0f)), 1);
  }
  Meter a(automatic(0.3f)), b(automatic(0.3f));
  for (int i = 0; i < 6; ++i) EXPECT_EQ(a.frame(image).factor, b.frame(image).factor);
}

}  // namespace
}  // namespace heliograph::test
