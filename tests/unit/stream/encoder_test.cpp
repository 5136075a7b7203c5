#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "stream/encoders/base64.hpp"
#include "stream/encoders/jpeg_encoder.hpp"
#include "stream/encoders/png_encoder.hpp"

namespace heliograph::stream {
namespace {

struct Pixels {
  std::uint32_t width;
  std::uint32_t height;
  std::vector<std::uint8_t> rgba;
  ImageView view() const { return {width, height, rgba}; }
};

/// A smooth image with one hard red and blue edge, odd in both sizes.
Pixels test_image(std::uint32_t width = 97, std::uint32_t height = 61) {
  Pixels pixels{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const bool red = x > width / 2;
      pixels.rgba.push_back(red ? 230 : 20);
      pixels.rgba.push_back(static_cast<std::uint8_t>(y * 255 / height));
      pixels.rgba.push_back(red ? 20 : 230);
      pixels.rgba.push_back(static_cast<std::uint8_t>(x));
    }
  }
  return pixels;
}

struct Decoded {
  int width = 0;
  int height = 0;
  int sampling = -1;
  std::vector<std::uint8_t> rgba;
};

Decoded decode_jpeg(const std::vector<std::uint8_t>& file) {
  Decoded decoded;
  void* handle = tjInitDecompress();
  int colours = 0;
  EXPECT_EQ(tjDecompressHeader3(handle, file.data(), file.size(), &decoded.width, &decoded.height,
                                &decoded.sampling, &colours),
            0);
  decoded.rgba.resize(static_cast<std::size_t>(decoded.width) * decoded.height * 4);
  EXPECT_EQ(tjDecompress2(handle, file.data(), file.size(), decoded.rgba.data(), decoded.width, 0,
                          decoded.height, TJPF_RGBX, 0),
            0);
  tjDestroy(handle);
  return decoded;
}

double mean_error(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 != 3) sum += std::abs(a[i] - b[i]);
  }
  return sum / (0.75 * static_cast<double>(a.size()));
}

TEST(Jpeg, ThreadsEncodeAtTheSameTime) {
  JpegEncoder encoder;
  std::array<Pixels, 4> images;
  std::array<std::vector<std::uint8_t>, 4> alone;
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i] = test_image(64 + 16 * static_cast<std::uint32_t>(i), 48);
    alone[i] = encoder.encode(images[i].view(), 80, ChromaSampling::half);
  }
  std::array<int, 4> same{};
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < images.size(); ++i) {
      threads.emplace_back([&, i] {
        for (int k = 0; k < 50; ++k) {
          same[i] += encoder.encode(images[i].view(), 80, ChromaSampling::half) == alone[i];
        }
      });
    }
  }
  for (const int count : same) EXPECT_EQ(count, 50);
}

TEST(JpegEncoder, KeepsSizeAndColours) {
  const Pixels pixels = test_image();
  JpegEncoder encoder;
  const Decoded decoded = decode_jpeg(encoder.encode(pixels.view(), 80, ChromaSampling::half));
  EXPECT_EQ(decoded.width, 97);
  EXPECT_EQ(decoded.height, 61);
  EXPECT_EQ(decoded.sampling, TJSAMP_420);
  EXPECT_LT(mean_error(decoded.rgba, pixels.rgba), 6.0);
}

TEST(JpegEncoder, FullChromaKeepsColouredEdgesThatHalfChromaSmears) {
  const Pixels pixels = test_image();
  JpegEncoder encoder;
  const Decoded full = decode_jpeg(encoder.encode(pixels.view(), 95, ChromaSampling::full));
  const Decoded half = decode_jpeg(encoder.encode(pixels.view(), 95, ChromaSampling::half));
  EXPECT_EQ(full.sampling, TJSAMP_444);
  EXPECT_LT(mean_error(full.rgba, pixels.rgba), 0.5 * mean_error(half.rgba, pixels.rgba));
}

TEST(JpegEncoder, IsReusableForOtherSizesAndQualities) {
  JpegEncoder encoder;
  const std::size_t good = encoder.encode(test_image().view(), 95, ChromaSampling::half).size();
  const auto large = encoder.encode(test_image(640, 360).view(), 50, ChromaSampling::half);
  EXPECT_EQ(decode_jpeg(large).width, 640);
  EXPECT_LT(encoder.encode(test_image().view(), 30, ChromaSampling::half).size(), good);
  EXPECT_EQ(encoder.encode(test_image().view(), 95, ChromaSampling::half).size(), good);
}

TEST(JpegEncoder, RefusesAnIncompleteImage) {
  Pixels pixels = test_image();
  pixels.rgba.pop_back();
  JpegEncoder encoder;
  EXPECT_THROW(encoder.encode(pixels.view(), 80, ChromaSampling::half), std::runtime_error);
  EXPECT_THROW(encoder.encode({}, 80, ChromaSampling::half), std::runtime_error);
}

TEST(PngEncoder, IsLossless) {
  const Pixels pixels = test_image();
  const std::vector<std::uint8_t> file = encode_png(pixels.view());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, file.data(), file.size()));
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB)) << "alpha must be gone";
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr));
  EXPECT_EQ(image.width, pixels.width);
  EXPECT_EQ(mean_error(rgba, pixels.rgba), 0.0);
}

TEST(PngEncoder, RefusesAnIncompleteImage) {
  EXPECT_THROW(encode_png({}), std::runtime_error);
}

std::string base64_of(std::string_view text) {
  return base64_encode({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Base64, MatchesTheExamplesOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
}

TEST(Base64Url, DecodesWithoutPaddingAndRefusesTheRest) {
  EXPECT_EQ(base64url_decode("Zm9vYg"), "foob");
  EXPECT_EQ(base64url_decode("_-8"), "\xff\xef");
  EXPECT_EQ(base64url_decode("Zg=="), std::nullopt);
  EXPECT_EQ(base64url_decode("Zm9vY"), std::nullopt);
  EXPECT_EQ(base64url_decode("Z+8"), std::nullopt);
}

}  // namespace
}  // namespace heliograph::stream
