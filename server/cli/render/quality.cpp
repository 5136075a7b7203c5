#include "cli/render/quality.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace heliograph::cli {
namespace {

constexpr std::size_t window = 8;  // pixels, each side
constexpr std::size_t step = 4;    // from window to window
constexpr double c2 = (0.03 * 255) * (0.03 * 255);

/// Rec. 601, as the similarity is usually computed.
std::vector<float> luma_of(std::span<const std::uint8_t> rgba) {
  std::vector<float> luma(rgba.size() / 4);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    luma[i] = 0.299f * static_cast<float>(rgba[4 * i]) +
              0.587f * static_cast<float>(rgba[4 * i + 1]) +
              0.114f * static_cast<float>(rgba[4 * i + 2]);
  }
  return luma;
}

struct WindowSums {
  double value = 0.0;
  double square = 0.0;
  double difference = 0.0;  // squared
};

}  // namespace

std::optional<double> QualityEstimate::add(std::span<const std::uint8_t> rgba, std::uint32_t width,
                                           std::uint32_t samples) {
  std::vector<float> luma = luma_of(rgba);
  std::optional<double> similarity;
  if (before_samples_ > 0 && samples == 2 * before_samples_) {
    similarity = expected_similarity(luma, before_, width);
    half_ = expected_similarity(luma, before_, width, 2.0);
  }
  before_ = std::move(luma);
  before_samples_ = samples;
  next_ = 2 * samples;
  return similarity;
}

std::optional<std::uint32_t> SampleForecast::next() {
  if (left_ == 0) return std::nullopt;
  --left_;
  return samples_;
}

void SampleForecast::add(std::uint32_t samples, bool half_suffices) {
  samples_ = samples / 2;
  left_ = half_suffices ? frames : 0;
}

double expected_similarity(std::span<const float> image, std::span<const float> other,
                           std::uint32_t width, double noise_scale) {
  const std::size_t height = image.size() / width;
  const std::size_t wide = std::min<std::size_t>(window, width);
  const std::size_t high = std::min(window, height);
  double sum = 0.0;
  std::size_t windows = 0;
  for (std::size_t top = 0; top + high <= height; top += step) {
    for (std::size_t left = 0; left + wide <= width; left += step) {
      WindowSums sums;
      for (std::size_t y = top; y < top + high; ++y) {
        for (std::size_t x = left; x < left + wide; ++x) {
          const double value = image[y * width + x];
          const double difference = value - other[y * width + x];
          sums.value += value;
          sums.square += value * value;
          sums.difference += difference * difference;
        }
      }
      const auto count = static_cast<double>(wide * high);
      const double mean = sums.value / count;
      const double noise = sums.difference / count;
      const double own = std::max(0.0, sums.square / count - mean * mean - noise);
      sum += (2.0 * own + c2) / (2.0 * own + noise_scale * noise + c2);
      ++windows;
    }
  }
  return sum / static_cast<double>(windows);
}

}  // namespace heliograph::cli
