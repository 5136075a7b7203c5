#include <gtest/gtest.h>

#include <algorithm>

#include "scene/image/image_decoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

Bytes decoded(const Bytes& file) {
  const ImageSize size = probe_image(file);
  Bytes pixels(std::size_t(size.width) * size.height * 4);
  decode_image(file, size, pixels);
  return pixels;
}

std::string reason_of(const Bytes& file) {
  try {
    decoded(file);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "";
}

Image with_mips(std::uint32_t width, std::uint32_t height, bool srgb, const Bytes& level0) {
  Image image{"", width, height, mip_level_count(width, height), srgb, level0};
  image.pixels.resize(mip_chain_bytes(width, height));
  fill_mip_chain(image);
  return image;
}

TEST(ImageDecoder, GrayAndRgbBecomeOpaqueRgba) {
  EXPECT_EQ(decoded(png(2, 1, 1, {7, 9})), (Bytes{7, 7, 7, 255, 9, 9, 9, 255}));
  EXPECT_EQ(decoded(png(1, 1, 3, {1, 2, 3})), (Bytes{1, 2, 3, 255}));
  EXPECT_EQ(decoded(png(1, 1, 4, {1, 2, 3, 4})), (Bytes{1, 2, 3, 4}));
}

TEST(ImageDecoder, SixteenBitsAreReducedToEight) {
  EXPECT_EQ(decoded(png(1, 1, 4, {0x12, 0x34, 0xff, 0xff, 0, 0, 0x80, 0}, 16)),
            (Bytes{0x12, 0xff, 0, 0x80}));
}

TEST(ImageDecoder, ReadsJpegBaselineAndProgressive) {
  Bytes rgb;
  for (int i = 0; i < 16 * 16; ++i) rgb.insert(rgb.end(), {200, 100, 50});
  for (const bool progressive : {false, true}) {
    const Bytes pixels = decoded(jpeg(16, 16, rgb, progressive));
    EXPECT_NEAR(pixels[0], 200, 3);
    EXPECT_NEAR(pixels[1], 100, 3);
    EXPECT_NEAR(pixels[2], 50, 3);
    EXPECT_EQ(pixels[3], 255);
  }
}

TEST(ImageDecoder, GammaChunkIsIgnored) {
  // A gAMA chunk for linear data: a decoder that uses it would brighten the image.
  Bytes file = png(1, 1, 3, {100, 100, 100});
  const Bytes gamma = {0, 0, 0, 4, 'g', 'A', 'M', 'A', 0, 1, 0x86, 0xa0, 0x31, 0xe8, 0x96, 0x5f};
  file.insert(file.begin() + 33, gamma.begin(), gamma.end());
  EXPECT_EQ(decoded(file), (Bytes{100, 100, 100, 255}));
}

TEST(ImageDecoder, RejectsTruncatedFiles) {
  Bytes noise(48 * 48 * 3);
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = static_cast<std::uint8_t>(i * 2654435761u >> 13);
  for (const Bytes& file :
       {png(5, 4, 3, Bytes(60, 3)), jpeg(48, 48, noise), jpeg(48, 48, noise, true)}) {
    ASSERT_EQ(reason_of(file), "");
    for (std::size_t size = 0; size < file.size() - 2; size += 1 + file.size() / 200) {
      EXPECT_NE(reason_of(Bytes(file.begin(), file.begin() + size)), "")
          << size << " of " << file.size();
    }
  }
}

TEST(ImageDecoder, RejectsOtherFormats) {
  EXPECT_NE(reason_of({}).find("neither PNG, JPEG, WebP nor KTX2"), std::string::npos);
  EXPECT_NE(reason_of({'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0, 0, 0}).find("neither"),
            std::string::npos);
}

TEST(ImageDecoder, RejectsEmptyAndOversizedImages) {
  EXPECT_NE(reason_of(png(0, 0, 4, {})), "");
  EXPECT_NE(reason_of(png(1, 0, 4, {})), "");
  EXPECT_NE(reason_of(png(100'000, 100'000, 4, {})), "");
  EXPECT_NE(reason_of(png(8193, 1, 4, Bytes(8193 * 4))), "");
}

TEST(ImageDecoder, FewRowsBeyondImageHeightAreIgnoredAndManyRefused) {
  Bytes samples(256, 77);
  std::fill_n(samples.begin(), 64, std::uint8_t(5));
  EXPECT_EQ(decoded(png(4, 4, 4, samples)), Bytes(64, 5));
  // 16 MiB of rows after a header of 4 x 4: a decoder that inflates first would allocate them all.
  samples.resize(16 << 20, 77);
  EXPECT_THROW(decoded(png(4, 4, 4, samples)), ImportError);
}

TEST(Mipmaps, ChainEndsAtOnePixel) {
  EXPECT_EQ(mip_level_count(1, 1), 1u);
  EXPECT_EQ(mip_level_count(256, 256), 9u);
  EXPECT_EQ(mip_level_count(5, 3), 3u);
  EXPECT_EQ(mip_chain_bytes(5, 3), (15u + 2u + 1u) * 4u);
}

TEST(Mipmaps, SrgbColorsAreAveragedInLinearSpace) {
  const Bytes checker = {0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0};
  const Image color = with_mips(2, 2, true, checker);
  const Image data = with_mips(2, 2, false, checker);
  EXPECT_EQ(color.pixels[16], 188) << "half of white's luminance is 188 in sRGB";
  EXPECT_EQ(color.pixels[19], 128) << "alpha is linear";
  EXPECT_EQ(data.pixels[16], 128);
}

TEST(Mipmaps, UniformImageIsUnchanged) {
  for (int value = 0; value < 256; ++value) {
    for (const bool srgb : {false, true}) {
      for (const std::uint32_t side : {4u, 7u}) {
        const Image image =
            with_mips(side, side, srgb, Bytes(side * side * 4, static_cast<std::uint8_t>(value)));
        ASSERT_EQ(image.pixels.back(), value);
        ASSERT_EQ(image.pixels[image.pixels.size() - 4], value) << srgb << " " << side;
      }
    }
  }
}

TEST(Mipmaps, OddSizesWeightPixelsEqually) {
  // 3 -> 1: each of the three pixels has weight 1/3.
  for (int bright = 0; bright < 3; ++bright) {
    Bytes row(12, 0);
    row[4 * bright] = 255;
    EXPECT_EQ(with_mips(3, 1, false, row).pixels[12], 85);
  }
}

TEST(Images, AreReadFromFilesBesideScene) {
  GltfBuilder builder = everything();
  builder.json["images"][0] = {{"uri", "my%20image.png"}};
  builder.json["buffers"][0]["uri"] = "data.bin";
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "textures");
  folder.write("my image.png", png(2, 2, 3, Bytes(12, 50)));
  folder.write("data.bin", builder.binary);
  const Scene scene = import_gltf(folder.write("scene.gltf", builder.json.dump()));
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[0].pixels[0], 50);
  EXPECT_EQ(scene.name, "scene");

  builder.json["images"][0] = {{"uri", "textures/../textures/inner.png"}};
  folder.write("textures/inner.png", png(2, 2, 3, Bytes(12, 60)));
  EXPECT_EQ(import_gltf(folder.write("scene.gltf", builder.json.dump())).images[0].pixels[0], 60);
}

TEST(Images, AreReadFromDataUris) {
  GltfBuilder builder = everything();
  builder.json["images"][0] = {
      {"uri", "data:image/png;base64," + base64(png(2, 2, 3, Bytes(12, 77)))}};
  builder.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + base64(builder.binary);
  const TemporaryFolder folder;
  const Scene scene = import_gltf(folder.write("scene.gltf", builder.json.dump()));
  EXPECT_EQ(scene.images[0].pixels[0], 77);
  EXPECT_EQ(scene.triangle_count(), 2u);
}

}  // namespace
}  // namespace heliograph::scene::test
