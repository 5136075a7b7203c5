#include "scene/image/bc7/bc7_image.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/image/bc7/block_encoder.hpp"
#include "scene/image/bc7/format.hpp"

namespace heliograph::scene {
namespace {

struct RgbaLevel {
  const std::uint8_t* pixels;
  std::uint32_t width;
  std::uint32_t height;

  std::uint32_t columns() const { return (width + 3) / 4; }  // of blocks
  std::uint32_t rows() const { return (height + 3) / 4; }
};

std::array<std::uint8_t, 64> texels_at(const RgbaLevel& level, std::uint32_t column,
                                       std::uint32_t row) {
  std::array<std::uint8_t, 64> texels;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const std::uint32_t x = std::min(4 * column + i % 4, level.width - 1);
    const std::uint32_t y = std::min(4 * row + i / 4, level.height - 1);
    std::copy_n(level.pixels + (std::size_t{y} * level.width + x) * 4, 4, texels.data() + 4 * i);
  }
  return texels;
}

/// @return the sum of squared differences
double encode_row(const RgbaLevel& level, std::uint32_t row, std::uint8_t* blocks) {
  double error = 0.0;
  for (std::uint32_t column = 0; column < level.columns(); ++column) {
    const bc7::EncodedBlock block = bc7::encode_block(texels_at(level, column, row));
    blocks = std::ranges::copy(block.bytes, blocks).out;
    error += block.error;
  }
  return error;
}

}  // namespace

Bc7Levels encode_bc7(const Image& image, std::span<const std::uint8_t> pixels) {
  Bc7Levels result;
  double error = 0.0;
  RgbaLevel level{pixels.data(), image.width, image.height};
  for (std::uint32_t i = 0; i < image.levels; ++i) {
    const std::size_t first = result.blocks.size();
    const std::size_t row_bytes = std::size_t{level.columns()} * bc7::block_bytes;
    result.blocks.resize(first + row_bytes * level.rows());
    // Summed in order: whether a texture stays compressed does not depend on threads.
    std::vector<double> errors(level.rows());
    tbb::parallel_for(std::uint32_t{0}, level.rows(), [&](std::uint32_t row) {
      errors[row] = encode_row(level, row, result.blocks.data() + first + row * row_bytes);
    });
    for (const double row_error : errors) error += row_error;
    level = {level.pixels + std::size_t{level.width} * level.height * 4,
             std::max(level.width / 2, 1u), std::max(level.height / 2, 1u)};
  }
  constexpr double channels = 3.0;
  const double samples = channels * bc7::texels_of_block *
                         static_cast<double>(result.blocks.size() / bc7::block_bytes);
  result.signal_to_noise = 10.0 * std::log10(255.0 * 255.0 * samples / error);
  return result;
}

}  // namespace heliograph::scene
