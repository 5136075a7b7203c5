#include "scene/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "scene/import.hpp"

namespace heliograph::scene::test {
namespace {

constexpr int width = 64, height = 32;

/// Smooth, up to `peak`, without symmetry.
glm::vec3 color_at(int x, int y, float peak) {
  return peak * glm::vec3(float(x) / width, float(y) / height, 0.5f + 0.4f * float(x * y) / 2048);
}

/// An output stream into memory.
class MemorySink : public Imf::OStream {
 public:
  MemorySink() : OStream("image") {}
  void write(const char* bytes, int count) override {
    if (position_ + count > bytes_.size()) bytes_.resize(position_ + count);
    std::memcpy(bytes_.data() + position_, bytes, count);
    position_ += count;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

struct Style {
  Imf::Compression compression = Imf::NO_COMPRESSION;
  Imf::PixelType type = Imf::FLOAT;
  std::string layer = "";
  bool tiled = false;
  float peak = 100.0f;
};

std::vector<std::uint8_t> write_rgb(const Style& style, Imf::Header header = {width, height}) {
  header.compression() = style.compression;
  std::vector<glm::vec3> pixels;
  std::vector<std::array<half, 3>> halves;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 color = color_at(x, y, style.peak);
      pixels.push_back(color);
      halves.push_back({half(color.x), half(color.y), half(color.z)});
    }
  }
  const bool is_half = style.type == Imf::HALF;
  const std::size_t channel_size = is_half ? 2 : 4;
  char* data =
      is_half ? reinterpret_cast<char*>(halves.data()) : reinterpret_cast<char*>(pixels.data());
  Imf::FrameBuffer frame;
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    header.channels().insert(style.layer + names[c], Imf::Channel(style.type));
    frame.insert(style.layer + names[c], Imf::Slice(style.type, data + channel_size * c,
                                                    3 * channel_size, 3 * channel_size * width));
  }
  MemorySink sink;
  if (style.tiled) {
    header.setTileDescription(Imf::TileDescription(16, 16));
    Imf::TiledOutputFile file(sink, header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  } else {
    Imf::OutputFile file(sink, header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  return sink.bytes();
}

void expect_colors(const Environment& environment, float peak, float tolerance) {
  ASSERT_EQ(environment.width, std::uint32_t(width));
  ASSERT_EQ(environment.height, std::uint32_t(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 got = environment.radiance[std::size_t(y) * width + x];
      ASSERT_LE(glm::distance(got, color_at(x, y, peak)), tolerance * peak) << x << " " << y;
    }
  }
}

TEST(Exr, ReadsEveryCompression) {
  for (const auto& [compression, tolerance] : {std::pair{Imf::NO_COMPRESSION, 1e-6f},
                                               {Imf::RLE_COMPRESSION, 1e-6f},
                                               {Imf::ZIPS_COMPRESSION, 1e-6f},
                                               {Imf::ZIP_COMPRESSION, 1e-6f},
                                               {Imf::PIZ_COMPRESSION, 1e-6f},
                                               {Imf::PXR24_COMPRESSION, 1e-3f},
                                               {Imf::B44_COMPRESSION, 1e-6f},
                                               {Imf::B44A_COMPRESSION, 1e-6f},
                                               {Imf::DWAA_COMPRESSION, 0.03f},
                                               {Imf::DWAB_COMPRESSION, 0.03f}}) {
    SCOPED_TRACE(int(compression));
    expect_colors(decode_exr(write_rgb({.compression = compression})), 100.0f, tolerance);
    // B44 is lossy and compresses half floats only.
    const float of_halves = std::max(
        tolerance, compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION
                       ? 0.05f
                       : 2e-3f);
    expect_colors(decode_exr(write_rgb({.compression = compression, .type = Imf::HALF})), 100.0f,
                  of_halves);
  }
}

TEST(Exr, ReadsTilesLayersAndFullFloats) {
  expect_colors(decode_exr(write_rgb({.tiled = true})), 100.0f, 1e-6f);
  expect_colors(decode_exr(write_rgb({.layer = "sky.top."})), 100.0f, 1e-6f);
  expect_colors(decode_exr(write_rgb({.peak = 3e5f})), 3e5f, 1e-6f);
}

TEST(Exr, DataWindowMayHaveAnyOffset) {
  Imf::Header header(Imath::Box2i({-20, 30}, {-20 + width - 1, 30 + height - 1}),
                     Imath::Box2i({-20, 30}, {-20 + width - 1, 30 + height - 1}));
  header.compression() = Imf::NO_COMPRESSION;
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> grey(width * height, 0.0f);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = float(i);
  Imf::FrameBuffer frame;
  char* origin = reinterpret_cast<char*>(grey.data() + 20 - 30 * width);
  frame.insert("Y", Imf::Slice(Imf::FLOAT, origin, sizeof(float), sizeof(float) * width));
  MemorySink sink;
  {
    Imf::OutputFile file(sink, header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  const Environment environment = decode_exr(sink.bytes());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    ASSERT_EQ(environment.radiance[i], glm::vec3(grey[i])) << i;
  }
}

TEST(Exr, ReadsLuminanceAndChroma) {
  std::vector<Imf::Rgba> pixels;
  for (int i = 0; i < width * height; ++i) {
    const glm::vec3 color = color_at(i % width, i / width, 1.0f);
    pixels.emplace_back(color.x, color.y, color.z);
  }
  MemorySink sink;
  {
    Imf::RgbaOutputFile file(sink, Imf::Header(width, height), Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, width);
    file.writePixels(height);
  }
  // Chroma is filtered, with errors at the edges.
  expect_colors(decode_exr(sink.bytes()), 1.0f, 0.1f);
}

std::string refusal(const std::vector<std::uint8_t>& file) {
  try {
    decode_exr(file);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "";
}

TEST(Exr, ErrorsNameUnsupportedFeatures) {
  Imf::Header cube(width, height);
  Imf::addEnvmap(cube, Imf::ENVMAP_CUBE);
  EXPECT_NE(refusal(write_rgb({}, cube)).find("cube map"), std::string::npos);
  Imf::Header part(Imath::Box2i({0, 0}, {2 * width, height}),
                   Imath::Box2i({0, 0}, {width - 1, height - 1}));
  EXPECT_NE(refusal(write_rgb({}, part)).find("display window"), std::string::npos);
  const std::vector<std::uint8_t> whole = write_rgb({.compression = Imf::ZIP_COMPRESSION});
  for (const std::size_t length : {4, 40, 300, int(whole.size()) / 2, int(whole.size()) - 1}) {
    EXPECT_NE(refusal({whole.begin(), whole.begin() + length}), "") << length;
  }
}

// Damaged files give an error or an image, never a crash.
TEST(Exr, DamageIsSafe) {
  for (const auto compression :
       {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    const std::vector<std::uint8_t> whole = write_rgb({.compression = compression});
    for (std::size_t i = 8; i < whole.size(); i += 1 + whole.size() / 200) {
      std::vector<std::uint8_t> damaged = whole;
      damaged[i] ^= 0xff;
      refusal(damaged);
    }
  }
}

// Found by fuzzing: OpenEXR allocated the claimed size of an attribute before checking its data.
TEST(Exr, AttributeSizesAreLimitedByFileSize) {
  const std::vector<std::uint8_t> whole = write_rgb({});
  const auto with_attribute = [&](std::uint32_t claimed, std::size_t bytes) {
    std::vector<std::uint8_t> file = whole;
    std::vector<std::uint8_t> attribute = {'x', 0, 'm', 'i', 'n', 'e', 0};
    for (int shift = 0; shift < 32; shift += 8) attribute.push_back(std::uint8_t(claimed >> shift));
    attribute.resize(attribute.size() + bytes);
    file.insert(file.begin() + 8, attribute.begin(), attribute.end());
    return refusal(file);
  };
  EXPECT_NE(with_attribute(100, 100), "has a damaged header");
  for (const std::uint32_t claimed : {0x00100000u, 0x65726373u, 0x7fffffffu, 0xffffffffu}) {
    EXPECT_EQ(with_attribute(claimed, 100), "has a damaged header");
  }
  // A channel list that claims to be too short: the rest would be misread.
  std::vector<std::uint8_t> file = whole;
  const std::string_view type = "chlist";
  const auto found = std::search(file.begin(), file.end(), type.begin(), type.end());
  *(found + 7) -= 1;
  EXPECT_EQ(refusal(file), "has a damaged header");
}

TEST(Exr, DetectsFormatByMagicAndClampsNegativeRadiance) {
  const auto path = std::filesystem::temp_directory_path() / "heliograph_exr_test.image";
  std::vector<std::uint8_t> file = write_rgb({.peak = -1.0f});
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
  const Environment environment = load_environment(path);
  std::filesystem::remove(path);
  EXPECT_EQ(environment.radiance[700], glm::vec3(0.0f));
}

}  // namespace
}  // namespace heliograph::scene::test
