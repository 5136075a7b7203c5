#include "render/passes/post/present.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/passes/post/filter_mean.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{64, 64};

// The dither's triangular distribution is half as wide as an exact mean would need: 1/8 code value.
// Stores to 8 bits may be off by 0.6 of a step instead of 0.5 (Vulkan, fixed-point conversion).
double tolerance() {
  return (device().is_cpu() ? 0.13 : 0.23) / 255.0;
}

class PresentTest : public testing::Test {
 protected:
  /// The presented image of uniform `radiance`, in code values.
  render::FloatImage present(const glm::vec3& radiance, const protocol::Settings& settings) {
    FrameRig rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}),
                 {.extent = extent, .settings = settings});
    const auto image = rig.input("radiance", VK_FORMAT_R32G32B32A32_SFLOAT,
                                 std::vector(extent.width * extent.height, glm::vec4(radiance, 1)));
    const auto exposure = render::expose(rig.plan(), rig.inputs(), image, image);
    const auto mean = render::filter_mean(rig.plan(), rig.inputs(), exposure, image, image);
    const auto weight = render::weigh_mean(rig.plan(), rig.inputs(), exposure, image, mean);
    const auto presented = render::present(rig.plan(), rig.inputs(), exposure, image, mean, weight);
    rig.run();
    const render::FloatImage first = rig.read(presented);
    rig.run();
    EXPECT_EQ(first.rgba, rig.read(presented).rgba) << "dither must not change between frames";
    return first;
  }
  static glm::dvec3 mean(const render::FloatImage& image) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      for (int c = 0; c < 3; ++c) sum[c] += image.rgba[i + c];
      EXPECT_EQ(image.rgba[i + 3], 1.0f);
    }
    return sum * (4.0 / static_cast<double>(image.rgba.size()));
  }
  static double encode(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  }

  static protocol::Settings linear() {
    protocol::Settings settings = without_indirect();
    settings.tone_map.curve = protocol::ToneMapCurve::linear;
    return settings;
  }
};

TEST_F(PresentTest, DitherKeepsMeanWithinOneCodeValue) {
  const glm::vec3 radiance(0.1f, 0.4f, 0.02f);
  const render::FloatImage image = present(radiance, linear());
  const glm::dvec3 average = mean(image);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(average[c], encode(radiance[c]), tolerance()) << c;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    ASSERT_NEAR(image.rgba[i], encode(0.1), 1.01 / 255.0);
  }
}

TEST_F(PresentTest, ExposureIsInStops) {
  protocol::Settings settings = linear();
  settings.exposure.compensation = 2.0f;
  EXPECT_NEAR(mean(present(glm::vec3(0.1f), settings)).x, encode(0.4), tolerance());
  settings.exposure.compensation = -1.0f;
  EXPECT_NEAR(mean(present(glm::vec3(0.1f), settings)).x, encode(0.05), tolerance());
}

TEST_F(PresentTest, BlendsDenoisedAndAccumulatedBySampleCount) {
  protocol::Settings settings = linear();
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 8;
  FrameRig rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}),
               {.extent = extent, .settings = settings});
  const auto flat = [&](const char* name, float value) {
    return rig.input(name, VK_FORMAT_R32G32B32A32_SFLOAT,
                     std::vector(extent.width * extent.height, glm::vec4(glm::vec3(value), 1)));
  };
  const auto frame = flat("frame", 0.9f), average = flat("mean", 0.1f);
  const auto exposure = render::expose(rig.plan(), rig.inputs(), frame, average);
  const auto filtered = render::filter_mean(rig.plan(), rig.inputs(), exposure, frame, average);
  const auto weight = render::weigh_mean(rig.plan(), rig.inputs(), exposure, frame, filtered);
  const auto image = render::present(rig.plan(), rig.inputs(), exposure, frame, filtered, weight);
  for (const auto& [samples, expected] :
       {std::pair(0u, 0.9), {8u, 0.5}, {24u, 0.3}, {8000u, 0.1008}}) {
    rig.set_accumulated(samples);
    rig.run();
    EXPECT_NEAR(mean(rig.read(image)).x, encode(expected), tolerance()) << samples;
  }
  settings.antialiasing.temporal = false;  // nothing filters: the accumulated mean is shown
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular.enabled = false;
  rig.set_settings(settings);
  rig.set_accumulated(0);
  rig.run();
  EXPECT_NEAR(mean(rig.read(image)).x, encode(0.1), tolerance());
}

TEST_F(PresentTest, ClampsOverexposedAndNegativeValues) {
  const render::FloatImage image = present({50.0f, -1.0f, 0.0f}, linear());
  EXPECT_GT(mean(image).x, 1.0 - 0.2 / 255.0);
  EXPECT_LT(mean(image).y, 0.2 / 255.0);
}

TEST_F(PresentTest, ToneMapCurvesDiffer) {
  std::vector<double> greens;
  for (const auto curve : {protocol::ToneMapCurve::neutral, protocol::ToneMapCurve::aces,
                           protocol::ToneMapCurve::agx, protocol::ToneMapCurve::linear}) {
    protocol::Settings settings = without_indirect();
    settings.tone_map.curve = curve;
    const double green = mean(present({0.2f, 0.6f, 0.4f}, settings)).y;
    for (const double other : greens) EXPECT_GT(std::abs(green - other), 0.5 / 255.0);
    greens.push_back(green);
  }
}

}  // namespace
}  // namespace heliograph::test
