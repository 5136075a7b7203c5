#include <gtest/gtest.h>

#include "render/frame/frame_constants.hpp"

namespace heliograph::render {
namespace {

TEST(SampleJitter, StartsAtCenterAndStaysInsidePixel) {
  EXPECT_EQ(sample_jitter(0), glm::vec2(0.0f));
  for (std::uint32_t i = 0; i < 70000; ++i) {
    EXPECT_LE(glm::abs(sample_jitter(i)).x, 0.5f);
    EXPECT_LE(glm::abs(sample_jitter(i)).y, 0.5f);
  }
}

// A biased mean would shift the image as samples accumulate.
TEST(SampleJitter, AveragesToCenter) {
  for (const std::uint32_t count : {16u, 64u, 256u, 4096u}) {
    glm::dvec2 sum(0.0);
    for (std::uint32_t i = 0; i < count; ++i) sum += glm::dvec2(sample_jitter(i));
    EXPECT_LT(glm::length(sum / static_cast<double>(count)), 2.0 / count + 1e-4) << count;
  }
}

TEST(SampleJitter, CoversPixelEvenly) {
  std::array<int, 16> counts{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    const glm::vec2 cell = (sample_jitter(i) + 0.5f) * 3.9999f;
    ++counts[static_cast<std::size_t>(cell.y) * 4 + static_cast<std::size_t>(cell.x)];
  }
  for (const int count : counts) EXPECT_NEAR(count, 16, 5);
}

// Moving surfaces use the last dozen frames, from any position in the sequence.
TEST(SampleJitter, ConsecutiveFramesCoverAllQuarters) {
  for (std::uint32_t first = 1; first < 2000; ++first) {
    std::array<bool, 4> quarters{};
    glm::dvec2 sum(0.0);
    for (std::uint32_t i = 0; i < 16; ++i) {
      const glm::vec2 offset = sample_jitter(first + i);
      if (i < 9) quarters[(offset.x > 0.0f ? 1 : 0) + (offset.y > 0.0f ? 2 : 0)] = true;
      sum += glm::dvec2(offset);
    }
    for (const bool reached : quarters) EXPECT_TRUE(reached) << first;
    EXPECT_LT(glm::length(sum / 16.0), 0.15) << "mean offset is biased: " << first;
  }
}

}  // namespace
}  // namespace heliograph::render
