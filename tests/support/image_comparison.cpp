#include "tests/support/image_comparison.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tests/support/similarity.hpp"

namespace heliograph::test {
namespace {

/// Expected, actual and difference side by side.
render::Frame triptych(const render::Frame& expected, const render::Frame& actual) {
  constexpr int gain = 8;
  render::Frame wide;
  wide.width = expected.width * 3;
  wide.height = expected.height;
  wide.rgba.resize(expected.rgba.size() * 3, 255);
  const std::size_t row = std::size_t{expected.width} * 4;
  for (std::size_t y = 0; y < expected.height; ++y) {
    auto* out = wide.rgba.data() + y * row * 3;
    const auto* left = expected.rgba.data() + y * row;
    const auto* middle = actual.rgba.data() + y * row;
    std::copy_n(left, row, out);
    std::copy_n(middle, row, out + row);
    for (std::size_t i = 0; i < row; ++i) {
      if (i % 4 == 3) continue;
      out[2 * row + i] =
          static_cast<std::uint8_t>(std::min(gain * std::abs(left[i] - middle[i]), 255));
    }
  }
  return wide;
}

}  // namespace

void save_image(const std::string& name, const render::Frame& frame) {
  const char* folder = std::getenv("HELIOGRAPH_TEST_OUTPUT");
  if (!folder) return;
  std::filesystem::create_directories(folder);
  const std::string path = (std::filesystem::path(folder) / (name + ".png")).string();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = frame.width;
  image.height = frame.height;
  image.format = PNG_FORMAT_RGBA;
  ASSERT_TRUE(png_image_write_to_file(&image, path.c_str(), 0, frame.rgba.data(), 0, nullptr))
      << path << ": " << image.message;
}

void expect_similar(const std::string& name, const render::Frame& expected,
                    const render::Frame& actual, double mean, double similarity) {
  ASSERT_EQ(expected.width, actual.width);
  ASSERT_EQ(expected.height, actual.height);
  const double error = difference(expected, actual).mean;
  const double alike = ssim(expected, actual);
  EXPECT_LE(error, mean) << name;
  EXPECT_GE(alike, similarity) << name;
  if (error > mean || alike < similarity) {
    save_image(name + "_differs", triptych(expected, actual));
  }
}

}  // namespace heliograph::test
