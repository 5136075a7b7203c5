#include "render/passes/post/accumulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{19, 11};
constexpr std::size_t pixels = extent.width * extent.height;

class AccumulateTest : public testing::Test {
 protected:
  void SetUp() override { history_ = render::accumulate(rig_.plan(), rig_.inputs(), hdr_); }

  /// One frame of uniform `color` after `samples` accumulated samples.
  glm::vec4 frame(const glm::vec4& color, std::uint32_t samples) {
    rig_.fill(hdr_, std::vector(pixels, color));
    rig_.set_accumulated(samples);
    rig_.run();
    return texel(rig_.read(history_.current), 18, 10);
  }

  FrameRig rig_{SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}};
  gpu::ImageRef hdr_ =
      rig_.input("hdr", VK_FORMAT_R32G32B32A32_SFLOAT, std::vector(pixels, glm::vec4(0.0f)));
  gpu::History history_;
};

TEST_F(AccumulateTest, IsMeanOfAllSamples) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const glm::vec4 color(static_cast<float>(i * i % 17), 0.25f * static_cast<float>(i % 3), 1e4f,
                          1);
    sum += glm::dvec3(color);
    const glm::dvec3 mean = sum / (i + 1.0);
    const glm::vec4 got = frame(color, i);
    EXPECT_NEAR(got.x, mean.x, 1e-5 * mean.x + 1e-6) << i;
    EXPECT_NEAR(got.y, mean.y, 1e-5) << i;
    EXPECT_NEAR(got.z, 1e4, 1e-2) << i;
  }
}

// A difference of mean squares would have no correct digit left.
TEST_F(AccumulateTest, KeepsTheVarianceOfTheSamplesLuminance) {
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const double offset = static_cast<double>(i * i % 17);
    sum += offset;
    squares += offset * offset;
    const double mean = sum / (i + 1.0), expected = squares / (i + 1.0) - mean * mean;
    const float light = 20000.0f + static_cast<float>(offset);
    EXPECT_NEAR(frame(glm::vec4(light, light, light, 1), i).w, expected, 0.02 * expected + 0.02)
        << i;
  }
}

TEST_F(AccumulateTest, FirstSampleResetsHistory) {
  frame(glm::vec4(100, 50, 20, 1), 0);
  frame(glm::vec4(100, 50, 20, 1), 1);
  EXPECT_EQ(frame(glm::vec4(1, 2, 3, 1), 0), glm::vec4(1, 2, 3, 0));
}

TEST_F(AccumulateTest, ResetDiscardsNaNHistory) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  frame(glm::vec4(nan), 0);
  const glm::vec4 broken = frame(glm::vec4(1.0f), 1);
  EXPECT_TRUE(std::isnan(broken.x)) << "a NaN history must be read here";
  EXPECT_EQ(frame(glm::vec4(1, 2, 3, 1), 0), glm::vec4(1, 2, 3, 0));
  EXPECT_EQ(frame(glm::vec4(1, 2, 3, 1), 1), glm::vec4(1, 2, 3, 0));
}

}  // namespace
}  // namespace heliograph::test
