#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "scene/image/bc7/bc7_image.hpp"
#include "scene/image/bc7/block_encoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "tests/unit/scene/support/bc7_decoder.hpp"

namespace heliograph::scene::test {
namespace {

using BlockTexels = std::array<std::uint8_t, 64>;
using Rgba = std::array<double, 4>;

double squared_difference(const BlockTexels& a, const BlockTexels& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

struct Quality {
  double signal_to_noise = 0.0;  // dB, of all channels
  std::set<int> modes;
  std::set<int> partitions;
};

/// Encodes, decodes and compares blocks; what the encoder says of its error is what a decoder sees.
Quality measure(const std::vector<BlockTexels>& blocks) {
  Quality quality;
  double error = 0.0;
  for (const BlockTexels& texels : blocks) {
    const bc7::EncodedBlock encoded = bc7::encode_block(texels);
    const DecodedBlock decoded = decode_bc7(encoded.bytes);
    const double seen = squared_difference(decoded.rgba, texels);
    EXPECT_NEAR(encoded.error, seen, 1e-3 * seen) << "mode " << decoded.mode;
    error += seen;
    quality.modes.insert(decoded.mode);
    if (decoded.partition >= 0) quality.partitions.insert(decoded.partition);
  }
  const double samples = 64.0 * static_cast<double>(blocks.size());
  quality.signal_to_noise = 10.0 * std::log10(255.0 * 255.0 * samples / error);
  return quality;
}

/// Blocks of an image of 256 x 256 texels whose channels, 0..255, are a function of the place.
std::vector<BlockTexels> blocks_of(const std::function<Rgba(double x, double y)>& color) {
  constexpr int side = 256;
  std::vector<BlockTexels> blocks;
  for (int top = 0; top < side; top += 4) {
    for (int left = 0; left < side; left += 4) {
      BlockTexels& block = blocks.emplace_back();
      for (int i = 0; i < 16; ++i) {
        const Rgba texel = color(left + i % 4, top + i / 4);
        for (int c = 0; c < 4; ++c) {
          block[static_cast<std::size_t>(4 * i + c)] =
              static_cast<std::uint8_t>(std::lround(std::clamp(texel[c], 0.0, 255.0)));
        }
      }
    }
  }
  return blocks;
}

std::vector<BlockTexels> noise(int count, bool opaque) {
  std::mt19937 random(7);
  std::vector<BlockTexels> blocks(static_cast<std::size_t>(count));
  for (BlockTexels& block : blocks) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      block[i] = opaque && i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random());
    }
  }
  return blocks;
}

TEST(Bc7, BlocksOfOneColourAreExact) {
  std::mt19937 random(3);
  for (int i = 0; i < 1024; ++i) {
    std::array<std::uint8_t, 4> color;
    for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(random());
    color[static_cast<std::size_t>(i / 256)] = static_cast<std::uint8_t>(i);
    BlockTexels texels;
    for (std::size_t k = 0; k < texels.size(); ++k) texels[k] = color[k % 4];
    const bc7::EncodedBlock encoded = bc7::encode_block(texels);
    EXPECT_EQ(encoded.error, 0.0f);
    ASSERT_EQ(decode_bc7(encoded.bytes).rgba, texels) << i;
  }
}

TEST(Bc7, SmoothContentHasLittleError) {
  const auto gradient = [](double x, double y) { return Rgba{x, y, (x + y) / 2, 255}; };
  EXPECT_GT(measure(blocks_of(gradient)).signal_to_noise, 50.0);
  const auto fading = [](double x, double y) { return Rgba{x, 255 - y, 80, (x + y) / 2}; };
  EXPECT_GT(measure(blocks_of(fading)).signal_to_noise, 50.0);
  const auto waves = [](double x, double y) {
    return Rgba{128 + 90 * std::sin(0.05 * x), 128 + 90 * std::sin(0.06 * y),
                128 + 90 * std::sin(0.04 * (x + y)), 255};
  };
  EXPECT_GT(measure(blocks_of(waves)).signal_to_noise, 46.0);
}

TEST(Bc7, NormalsKeepTheirDirection) {
  const auto bumps = [](double x, double y) {
    const double slope_x = 0.5 * std::cos(0.15 * x), slope_y = 0.5 * std::cos(0.11 * y);
    const double length = std::sqrt(slope_x * slope_x + slope_y * slope_y + 1.0);
    return Rgba{127.5 - 127.5 * slope_x / length, 127.5 - 127.5 * slope_y / length,
                127.5 + 127.5 / length, 255};
  };
  EXPECT_GT(measure(blocks_of(bumps)).signal_to_noise, 44.0);
}

TEST(Bc7, EdgesBetweenTwoColoursStaySharp) {
  const auto shape = [](double x, double y) {
    const bool inside = std::sin(0.11 * x) + std::sin(0.13 * y + 0.02 * x) > 0.0;
    return inside ? Rgba{200, 40, 30, 255} : Rgba{20, 90, 220, 255};
  };
  EXPECT_GT(measure(blocks_of(shape)).signal_to_noise, 50.0);
  const auto leaf = [&](double x, double y) {
    const bool inside = std::sin(0.11 * x) + std::sin(0.13 * y) > 0.0;
    return Rgba{60 + 0.2 * x, 150 + 0.2 * y, 50, inside ? 255.0 : 0.0};
  };
  EXPECT_GT(measure(blocks_of(leaf)).signal_to_noise, 45.0);
}

/// Two subsets of texels with a gradient each, of different hues.
BlockTexels two_gradients(int partition, bool opaque) {
  BlockTexels block;
  for (int i = 0; i < 16; ++i) {
    const bool second = two_subset_partition(partition)[i] == '1';
    const int step = 5 * (i % 4) + 7 * (i / 4);
    const std::array<int, 4> texel = second ? std::array{40, 200 - step, 60 + step, 90}
                                            : std::array{210 - step, 60, 150 + step, 220};
    for (int c = 0; c < 4; ++c) {
      block[static_cast<std::size_t>(4 * i + c)] =
          opaque && c == 3 ? 255 : static_cast<std::uint8_t>(texel[static_cast<std::size_t>(c)]);
    }
  }
  return block;
}

TEST(Bc7, FindsEveryPartition) {
  for (const bool opaque : {true, false}) {
    std::vector<BlockTexels> blocks;
    for (int partition = 0; partition < 64; ++partition) {
      blocks.push_back(two_gradients(partition, opaque));
      const DecodedBlock decoded = decode_bc7(bc7::encode_block(blocks.back()).bytes);
      EXPECT_EQ(decoded.partition, partition) << "mode " << decoded.mode;
    }
    EXPECT_GT(measure(blocks).signal_to_noise, opaque ? 44.0 : 38.0);
  }
}

TEST(Bc7, UsesModesThatSuitTheContent) {
  std::vector<BlockTexels> blocks = noise(500, false);
  const std::vector<BlockTexels> opaque = noise(500, true);
  blocks.insert(blocks.end(), opaque.begin(), opaque.end());
  const auto patches = [](double x, double y) {
    const bool second = std::fmod(x + 0.3 * y, 11.0) < 5.0;
    const double step = 2.0 * std::fmod(x, 4.0);
    return second ? Rgba{40, 200 - step, 60, 255} : Rgba{210, 60 + step, 150 - step, 255};
  };
  const std::vector<BlockTexels> short_lines = blocks_of(patches);
  blocks.insert(blocks.end(), short_lines.begin(), short_lines.end());
  blocks.push_back(two_gradients(5, true));
  blocks.push_back(two_gradients(5, false));
  EXPECT_EQ(measure(blocks).modes, (std::set{1, 3, 5, 6, 7}));
}

TEST(Bc7, OpaqueStaysOpaque) {
  for (const BlockTexels& texels : noise(5000, true)) {
    const DecodedBlock decoded = decode_bc7(bc7::encode_block(texels).bytes);
    for (std::size_t i = 3; i < 64; i += 4) {
      ASSERT_EQ(decoded.rgba[i], 255) << "mode " << decoded.mode;
    }
  }
}

TEST(Bc7, AnythingCanBeEncoded) {
  EXPECT_GT(measure(noise(5000, false)).signal_to_noise, 14.0);
  // Only the extremes, which give the longest lines.
  std::vector<BlockTexels> blocks = noise(5000, false);
  for (BlockTexels& block : blocks) {
    for (std::uint8_t& value : block) value = value < 128 ? 0 : 255;
  }
  EXPECT_GT(measure(blocks).signal_to_noise, 8.0);
  // A single texel that differs by a single step.
  for (std::size_t i = 0; i < 64; ++i) {
    BlockTexels block;
    block.fill(100);
    block[i] = 101;
    EXPECT_LE(squared_difference(decode_bc7(bc7::encode_block(block).bytes).rgba, block), 16.0);
  }
}

/// Texels of one level of an image, from its blocks.
std::vector<std::uint8_t> decoded_level(std::span<const std::uint8_t> blocks, std::uint32_t width,
                                        std::uint32_t height) {
  std::vector<std::uint8_t> rgba(std::size_t{width} * height * 4);
  const std::size_t columns = (width + 3) / 4;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::size_t block = y / 4 * columns + x / 4;
      const DecodedBlock decoded = decode_bc7(blocks.subspan(16 * block).first<16>());
      std::copy_n(decoded.rgba.begin() + 4 * (y % 4 * 4 + x % 4), 4,
                  rgba.begin() + 4 * (std::size_t{y} * width + x));
    }
  }
  return rgba;
}

TEST(Bc7Image, LevelsOfAnySizeAreWholeBlocks) {
  Image image{"gradient", 21, 10, mip_level_count(21, 10), true, {}};
  image.pixels.resize(mip_chain_bytes(21, 10));
  for (std::uint32_t i = 0; i < 21 * 10; ++i) {
    const std::array<std::uint32_t, 4> texel{8 * (i % 21), 20 * (i / 21), 90, 255 - 3 * (i % 21)};
    for (std::size_t c = 0; c < 4; ++c) {
      image.pixels[4 * i + c] = static_cast<std::uint8_t>(texel[c]);
    }
  }
  fill_mip_chain(image);
  const Bc7Levels bc7 = encode_bc7(image, image.pixels);
  // 21 x 10, 10 x 5, 5 x 2, 2 x 1, 1 x 1
  ASSERT_EQ(bc7.blocks.size(), 16u * (6 * 3 + 3 * 2 + 2 + 1 + 1));
  EXPECT_GT(bc7.signal_to_noise, 38.0);
  std::size_t block = 0, texel = 0;
  for (std::uint32_t level = 0; level < image.levels; ++level) {
    const std::uint32_t width = std::max(21u >> level, 1u), height = std::max(10u >> level, 1u);
    const auto got = decoded_level(std::span(bc7.blocks).subspan(block), width, height);
    double difference = 0.0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      difference += std::abs(got[i] - image.pixels[texel + i]);
    }
    EXPECT_LT(difference / static_cast<double>(got.size()), 3.0) << "level " << level;
    block += std::size_t{(width + 3) / 4} * ((height + 3) / 4) * 16;
    texel += got.size();
  }
}

TEST(Bc7Image, TellsWhatIsLost) {
  Image image{"plain", 8, 8, mip_level_count(8, 8), false, {}};
  image.pixels.assign(mip_chain_bytes(8, 8), 77);
  EXPECT_TRUE(std::isinf(encode_bc7(image, image.pixels).signal_to_noise));
  std::mt19937 random(5);
  for (std::uint8_t& value : image.pixels) value = static_cast<std::uint8_t>(random());
  EXPECT_LT(encode_bc7(image, image.pixels).signal_to_noise, 25.0);
}

}  // namespace
}  // namespace heliograph::scene::test
