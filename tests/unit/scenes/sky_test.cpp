#include "scenes/generator/sky/sky.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scenes/generator/atrium/atrium.hpp"
#include "scenes/generator/scenes/test_scenes.hpp"

namespace heliograph::scenes {
namespace {

const ClearSky& sky() {
  static const ClearSky made =
      make_clear_sky(direction_to_sun(sun_elevation, sun_azimuth), 256, 128);
  return made;
}

float luminance(glm::vec3 c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

// A minimal decoder of the format that the encoder writes.
Environment decode_hdr(const std::vector<std::uint8_t>& file, int width, int height) {
  Environment out(width, height);
  std::size_t at = std::string(file.begin(), file.end()).find("+X ");
  while (file[at] != '\n') ++at;
  ++at;
  for (int y = 0; y < height; ++y) {
    EXPECT_EQ(file[at], 2);
    EXPECT_EQ(file[at + 2] * 256 + file[at + 3], width);
    at += 4;
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < std::size_t(4 * width)) {
      const int count = file[at++];
      if (count > 128) {
        bytes.insert(bytes.end(), std::size_t(count - 128), file[at++]);
      } else {
        for (int i = 0; i < count; ++i) bytes.push_back(file[at++]);
      }
    }
    for (int x = 0; x < width; ++x) {
      const auto plane = [&](int c) { return float(bytes[std::size_t(c * width + x)]); };
      out.at(x, y) =
          glm::vec3(plane(0), plane(1), plane(2)) * std::ldexp(1.0f, int(plane(3)) - 136);
    }
  }
  EXPECT_EQ(at, file.size());
  return out;
}

TEST(Sky, IsFiniteAndPositive) {
  for (const glm::vec3& pixel : sky().environment.radiance) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_TRUE(std::isfinite(pixel[c]));
      ASSERT_GT(pixel[c], 0.0f);
    }
  }
}

TEST(Sky, HasNoSunDisk) {
  float mean = 0.0f;
  float brightest = 0.0f;
  for (const glm::vec3& pixel : sky().environment.radiance) {
    mean += luminance(pixel) / float(sky().environment.radiance.size());
    brightest = std::max(brightest, luminance(pixel));
  }
  EXPECT_LT(brightest, 8.0f * mean);
}

TEST(Sky, IsBrightestAroundSun) {
  const glm::vec3 to_sun = direction_to_sun(sun_elevation, sun_azimuth);
  const Environment& e = sky().environment;
  float brightest = 0.0f;
  glm::vec3 where(0.0f);
  for (int y = 0; y < e.height / 2; ++y) {
    for (int x = 0; x < e.width; ++x) {
      if (luminance(e.at(x, y)) <= brightest) continue;
      brightest = luminance(e.at(x, y));
      where = e.direction(x, y);
    }
  }
  EXPECT_GT(glm::dot(where, to_sun), std::cos(glm::radians(4.0f)));
}

TEST(Sky, SunlightIsWarmAndFourToSixTimesSkylight) {
  const float sun =
      luminance(sky().sun_irradiance) * direction_to_sun(sun_elevation, sun_azimuth).y;
  const float ratio = sun / luminance(sky().sky_irradiance);
  EXPECT_GT(ratio, 4.0f);
  EXPECT_LT(ratio, 6.0f);
  EXPECT_GT(sky().sun_irradiance.x, sky().sun_irradiance.z);
  EXPECT_LT(sky().sky_irradiance.x, sky().sky_irradiance.z);
}

TEST(Sky, HorizonIsContinuous) {
  const Environment& e = sky().environment;
  for (int x = 0; x < e.width; x += 16) {
    const float above = luminance(e.at(x, e.height / 2 - 1));
    const float below = luminance(e.at(x, e.height / 2));
    EXPECT_NEAR(above, below, 0.15f * above);
  }
}

TEST(Hdr, RoundTrip) {
  const Environment& e = sky().environment;
  const Environment decoded = decode_hdr(encode_hdr(e), e.width, e.height);
  for (std::size_t i = 0; i < e.radiance.size(); ++i) {
    const glm::vec3 wanted = e.radiance[i];
    const float largest = std::max({wanted.x, wanted.y, wanted.z});
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(decoded.radiance[i][c], wanted[c], largest / 120.0f);
  }
}

TEST(Hdr, WhiteStaysExactlyOne) {
  const Environment white = make_white_environment();
  const Environment decoded = decode_hdr(encode_hdr(white), white.width, white.height);
  for (const glm::vec3& pixel : decoded.radiance) ASSERT_EQ(pixel, glm::vec3(1.0f));
}

TEST(Environment, ConstantIrradianceIsPi) {
  const glm::vec3 irradiance = make_white_environment().horizontal_irradiance();
  EXPECT_NEAR(irradiance.x, 3.14159f, 0.01f);
}

}  // namespace
}  // namespace heliograph::scenes
