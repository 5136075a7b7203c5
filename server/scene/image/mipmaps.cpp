#include "scene/image/mipmaps.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace heliograph::scene {
namespace {

// Levels are computed with 16 bits per channel, which keeps the darkest sRGB steps distinct.
struct ColorTables {
  std::array<std::uint16_t, 256> to_linear;
  std::array<std::uint16_t, 256> widen;
  std::vector<std::uint8_t> to_srgb;
  std::vector<std::uint8_t> narrow;
};

ColorTables make_color_tables() {
  ColorTables tables;
  tables.to_srgb.resize(65536);
  tables.narrow.resize(65536);
  for (int i = 0; i < 256; ++i) {
    const double encoded = i / 255.0;
    const double linear =
        encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    tables.to_linear[i] = static_cast<std::uint16_t>(std::lround(linear * 65535.0));
    tables.widen[i] = static_cast<std::uint16_t>(i * 257);
  }
  for (int i = 0; i < 65536; ++i) {
    const double linear = i / 65535.0;
    const double encoded =
        linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
    tables.to_srgb[i] = static_cast<std::uint8_t>(std::lround(encoded * 255.0));
    tables.narrow[i] = static_cast<std::uint8_t>((i + 128) / 257);
  }
  return tables;
}

const ColorTables& color_tables() {
  static const ColorTables tables = make_color_tables();
  return tables;
}

struct Taps {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> weights{};
};

// Source pixels along one axis that a target pixel covers, and their weights in units of 1 /
// target: two equal weights for even sizes, three for odd ones.
Taps taps_of(std::uint32_t pixel, std::uint32_t source, std::uint32_t target) {
  Taps taps;
  const std::uint64_t begin = std::uint64_t(pixel) * source;
  const std::uint64_t end = begin + source;
  taps.first = static_cast<std::uint32_t>(begin / target);
  for (std::uint64_t p = taps.first; p * target < end; ++p) {
    const std::uint64_t overlap = std::min(end, (p + 1) * target) - std::max(begin, p * target);
    taps.weights[taps.count++] = static_cast<std::uint32_t>(overlap);
  }
  return taps;
}

struct Level {
  std::uint8_t* pixels;
  std::uint32_t width;
  std::uint32_t height;
};

void halve(const Level& source, const Level& target, bool srgb) {
  const ColorTables& tables = color_tables();
  const std::array<std::uint16_t, 256>& decode = srgb ? tables.to_linear : tables.widen;
  const std::vector<std::uint8_t>& encode = srgb ? tables.to_srgb : tables.narrow;
  const std::uint64_t total = std::uint64_t(source.width) * source.height;
  std::vector<Taps> columns;
  for (std::uint32_t x = 0; x < target.width; ++x)
    columns.push_back(taps_of(x, source.width, target.width));

  for (std::uint32_t y = 0; y < target.height; ++y) {
    const Taps rows = taps_of(y, source.height, target.height);
    for (std::uint32_t x = 0; x < target.width; ++x) {
      const Taps& taps = columns[x];
      std::array<std::uint64_t, 4> sum{};
      for (std::uint32_t j = 0; j < rows.count; ++j) {
        const std::uint8_t* row =
            source.pixels + (std::size_t(rows.first + j) * source.width + taps.first) * 4;
        for (std::uint32_t i = 0; i < taps.count; ++i, row += 4) {
          const std::uint64_t weight = std::uint64_t(rows.weights[j]) * taps.weights[i];
          for (int c = 0; c < 3; ++c) sum[c] += weight * decode[row[c]];
          sum[3] += weight * tables.widen[row[3]];
        }
      }
      std::uint8_t* pixel = target.pixels + (std::size_t(y) * target.width + x) * 4;
      for (int c = 0; c < 3; ++c) pixel[c] = encode[(sum[c] + total / 2) / total];
      pixel[3] = tables.narrow[(sum[3] + total / 2) / total];
    }
  }
}

// The same for even sizes, where all weights are equal: most textures, and much faster.
void halve_even(const Level& source, const Level& target, bool srgb) {
  const ColorTables& tables = color_tables();
  const std::array<std::uint16_t, 256>& decode = srgb ? tables.to_linear : tables.widen;
  const std::uint8_t* encode = srgb ? tables.to_srgb.data() : tables.narrow.data();
  const std::size_t stride = std::size_t(source.width) * 4;
  std::uint8_t* pixel = target.pixels;
  for (std::uint32_t y = 0; y < target.height; ++y) {
    const std::uint8_t* row = source.pixels + 2 * y * stride;
    for (std::uint32_t x = 0; x < target.width; ++x, row += 8, pixel += 4) {
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t sum = decode[row[c]] + decode[row[c + 4]] + decode[row[c + stride]] +
                                  decode[row[c + stride + 4]];
        pixel[c] = encode[(sum + 2) / 4];
      }
      const std::uint32_t alpha = row[3] + row[7] + row[3 + stride] + row[7 + stride];
      pixel[3] = static_cast<std::uint8_t>((alpha + 2) / 4);
    }
  }
}

}  // namespace

std::uint32_t mip_level_count(std::uint32_t width, std::uint32_t height) {
  return static_cast<std::uint32_t>(std::bit_width(std::max({width, height, 1u})));
}

std::uint64_t mip_chain_bytes(std::uint32_t width, std::uint32_t height) {
  std::uint64_t bytes = 0;
  for (std::uint32_t level = 0; level < mip_level_count(width, height); ++level) {
    bytes += std::uint64_t(std::max(width >> level, 1u)) * std::max(height >> level, 1u) * 4;
  }
  return bytes;
}

std::uint64_t level_offset(const Image& image, std::uint32_t level) {
  std::uint64_t bytes = 0;
  for (std::uint32_t i = 0; i < level; ++i) {
    bytes += std::uint64_t(std::max(image.width >> i, 1u)) * std::max(image.height >> i, 1u) * 4;
  }
  return bytes;
}

std::uint32_t first_level_in(const Image& image, std::uint64_t bytes) {
  const std::uint64_t missing = level_offset(image, image.levels) - bytes;
  std::uint32_t level = 0;
  while (level + 1 < image.levels && level_offset(image, level) < missing) ++level;
  return level;
}

std::uint32_t first_level_within(const Image& image, std::uint32_t longest_side) {
  std::uint32_t level = 0;
  while (level + 1 < image.levels &&
         std::max(image.width >> level, image.height >> level) > longest_side) {
    ++level;
  }
  return level;
}

std::optional<std::uint32_t> longest_side_that_fits(std::span<const Image> images,
                                                    const KeptTextures& kept) {
  for (std::uint32_t longest = kept.longest_side; longest > 1; longest /= 2) {
    std::uint64_t bytes = 0;
    for (const Image& image : images) {
      bytes += level_offset(image, image.levels) -
               level_offset(image, first_level_within(image, longest));
    }
    if (bytes / 4 <= kept.most_texels) return longest;
  }
  return std::nullopt;
}

void fill_mip_chain(Image& image) {
  Level source{image.pixels.data(), image.width, image.height};
  for (std::uint32_t level = 1; level < image.levels; ++level) {
    const Level target{source.pixels + std::size_t(source.width) * source.height * 4,
                       std::max(source.width / 2, 1u), std::max(source.height / 2, 1u)};
    const bool even = source.width % 2 == 0 && source.height % 2 == 0;
    (even ? halve_even : halve)(source, target, image.srgb);
    source = target;
  }
}

}  // namespace heliograph::scene
