#include "scenes/generator/sky/studio.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace heliograph::scenes {
namespace {

TEST(Studio, WhiteIrradianceIsAboutPi) {
  const glm::vec3 irradiance = make_studio(128, 64).horizontal_irradiance();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c], 3.1416f, 0.15f);
}

TEST(Studio, SoftboxesAreBrighterThanWalls) {
  const Environment studio = make_studio(128, 64);
  float brightest = 0.0f;
  std::size_t bright = 0;
  for (const glm::vec3& radiance : studio.radiance) {
    EXPECT_GT(radiance.y, 0.0f);
    brightest = std::max(brightest, radiance.y);
    bright += radiance.y > 0.8f;
  }
  EXPECT_GT(brightest, 3.0f);
  const double share = double(bright) / double(studio.radiance.size());
  EXPECT_GT(share, 0.02);
  EXPECT_LT(share, 0.30);
}

TEST(Studio, MeanRadianceIsIndependentOfSize) {
  // Edges are averaged inside pixels: the size changes the detail, not the mean radiance.
  const glm::vec3 small = make_studio(64, 32).horizontal_irradiance();
  const glm::vec3 large = make_studio(256, 128).horizontal_irradiance();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(small[c], large[c], 0.05f * large[c]);
}

}  // namespace
}  // namespace heliograph::scenes
