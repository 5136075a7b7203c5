#include "stream/encoders/image_scaler.hpp"

#include <algorithm>
#include <cstddef>

#include "protocol/messages/scaled_size.hpp"

namespace heliograph::stream {
namespace {

constexpr std::size_t channels = 4;

/// Calls `use(i, weight)` for each of the `count` source positions that target position `at` of
/// `new_count` covers. Weights are in units of 1 / `new_count` of a source position; their sum is
/// `count`.
template <class Use>
void for_covered(std::size_t at, std::size_t count, std::size_t new_count, Use use) {
  const std::size_t begin = at * count;
  const std::size_t end = begin + count;
  for (std::size_t i = begin / new_count; i * new_count < end; ++i) {
    const std::size_t from = std::max(begin, i * new_count);
    const std::size_t to = std::min(end, (i + 1) * new_count);
    use(i, static_cast<float>(to - from));
  }
}

}  // namespace

ImageView ImageScaler::scale(const ImageView& image, int percent) {
  const std::uint32_t width = protocol::scaled_side(image.width, percent);
  const std::uint32_t height = protocol::scaled_side(image.height, percent);
  if (width == image.width && height == image.height) return image;
  pixels_.resize(channels * width * height);
  row_.resize(channels * image.width);
  const float area = static_cast<float>(image.width) * static_cast<float>(image.height);
  for (std::size_t y = 0; y < height; ++y) {
    std::fill(row_.begin(), row_.end(), 0.0f);
    for_covered(y, image.height, height, [&](std::size_t old_y, float weight) {
      const std::uint8_t* const old_row = image.rgba.data() + old_y * row_.size();
      for (std::size_t i = 0; i < row_.size(); ++i) row_[i] += weight * old_row[i];
    });
    for (std::size_t x = 0; x < width; ++x) {
      float sum[channels] = {};
      for_covered(x, image.width, width, [&](std::size_t old_x, float weight) {
        for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * row_[channels * old_x + c];
      });
      std::uint8_t* const pixel = pixels_.data() + channels * (y * width + x);
      for (std::size_t c = 0; c < channels; ++c) {
        pixel[c] = static_cast<std::uint8_t>(sum[c] / area + 0.5f);
      }
    }
  }
  return {.width = width, .height = height, .rgba = pixels_};
}

}  // namespace heliograph::stream
