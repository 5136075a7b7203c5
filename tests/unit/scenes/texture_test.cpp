#include "scenes/generator/textures/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "scenes/generator/atrium/atrium_materials.hpp"
#include "scenes/generator/textures/noise.hpp"

namespace heliograph::scenes {
namespace {

// Mean absolute difference of two neighbouring columns (or rows) of pixels.
double step_between(const Image& image, int first, int second, bool columns) {
  double sum = 0.0;
  const int length = columns ? image.height : image.width;
  for (int i = 0; i < length; ++i) {
    const std::uint8_t* a = columns ? image.at(first, i) : image.at(i, first);
    const std::uint8_t* b = columns ? image.at(second, i) : image.at(i, second);
    for (int c = 0; c < image.channels; ++c) sum += std::abs(int(a[c]) - int(b[c]));
  }
  return sum / double(length * image.channels);
}

double largest_inner_step(const Image& image, bool columns) {
  double largest = 0.0;
  const int size = columns ? image.width : image.height;
  for (int i = 0; i + 1 < size; ++i) {
    largest = std::max(largest, step_between(image, i, i + 1, columns));
  }
  return largest;
}

TEST(Textures, TileSeamlessly) {
  Document document;
  add_atrium_materials(document, Gloss::floor);
  int textured = 0;
  for (const Material& material : document.materials) {
    if (!material.texture) continue;
    ++textured;
    if (material.masked) continue;  // a single image, not a tile
    const TextureSet set = bake(*material.texture, 256);
    for (const Image* image : {&set.color, &set.normal, &set.surface}) {
      for (const bool columns : {true, false}) {
        const int last = (columns ? image->width : image->height) - 1;
        // The step across the border must not exceed the largest step inside.
        EXPECT_LE(step_between(*image, last, 0, columns),
                  1.1 * largest_inner_step(*image, columns) + 0.5)
            << material.name;
      }
    }
  }
  EXPECT_GE(textured, 22);
}

TEST(Textures, MaskedTexturesAreTransparentAtBorder) {
  Document document;
  add_atrium_materials(document, Gloss::floor);
  int masked = 0;
  for (const Material& material : document.materials) {
    if (!material.masked) continue;
    ++masked;
    const Image color = bake(*material.texture, 256).color;
    ASSERT_EQ(color.channels, 4);
    int opaque = 0;
    for (int i = 0; i < color.width; ++i) {
      EXPECT_LT(color.at(0, i)[3], 128);
      EXPECT_LT(color.at(color.width - 1, i)[3], 128);
      opaque += color.at(i, color.height / 2)[3] >= 128;
    }
    EXPECT_GT(opaque, color.width / 8) << material.name;
  }
  EXPECT_GE(masked, 1);
}

TEST(Textures, NormalMapTiltsAwayFromSlope) {
  TextureRecipe ramp;
  ramp.name = "ramp";
  ramp.width = 1.0f;
  ramp.sample = [](glm::vec2 uv) {
    SurfaceSample s;
    // Rises to the right in the left half and towards the bottom of the image in the upper half.
    s.height = 0.1f * (std::abs(uv.x - 0.5f) * -1.0f) + 0.1f * (std::abs(uv.y - 0.5f) * -1.0f);
    return s;
  };
  const TextureSet set = bake(ramp, 64);
  const std::uint8_t* upper_left = set.normal.at(16, 16);
  EXPECT_LT(upper_left[0], 127);  // the normal points to the left, against the rise
  EXPECT_GT(upper_left[1], 128);  // and to the top of the image (+Y)
  EXPECT_GT(upper_left[2], 200);
}

TEST(Textures, DeepJointsAreOccluded) {
  TextureRecipe groove;
  groove.name = "groove";
  groove.sample = [](glm::vec2 uv) {
    SurfaceSample s;
    s.height = std::abs(uv.x - 0.5f) < 0.02f ? -0.02f : 0.0f;
    return s;
  };
  const TextureSet set = bake(groove, 128);
  EXPECT_LT(set.surface.at(64, 10)[0], 200);
  EXPECT_EQ(set.surface.at(10, 10)[0], 255);
}

TEST(Noise, RepeatsWithPeriodOne) {
  for (const glm::vec2 p : {glm::vec2(0.13f, 0.71f), glm::vec2(0.5f, 0.02f)}) {
    const float here = fractal_noise(p, {4, 6}, 4, 9);
    EXPECT_NEAR(fractal_noise(p + glm::vec2(1, 0), {4, 6}, 4, 9), here, 1e-4f);
    EXPECT_NEAR(fractal_noise(p - glm::vec2(0, 1), {4, 6}, 4, 9), here, 1e-4f);
    EXPECT_NEAR(cellular_noise(p + glm::vec2(1, -1), {5, 7}, 3).nearest,
                cellular_noise(p, {5, 7}, 3).nearest, 1e-4f);
  }
}

}  // namespace
}  // namespace heliograph::scenes
