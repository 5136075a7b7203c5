#include "session/library/environment_thumbnail.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "stream/encoders/png_encoder.hpp"

namespace heliograph::session {

namespace {

constexpr std::uint32_t width = 160;
constexpr std::uint32_t height = 80;

float luminance(const glm::vec3& radiance) {
  return glm::dot(radiance, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// The mean of the pixels that one of the thumbnail covers.
glm::vec3 mean_at(const scene::Environment& environment, std::uint32_t x, std::uint32_t y) {
  const auto first = [](std::uint32_t at, std::uint32_t of, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::uint64_t{at} * size / of);
  };
  const std::uint32_t left = first(x, width, environment.width);
  const std::uint32_t top = first(y, height, environment.height);
  const std::uint32_t right = std::max(left + 1, first(x + 1, width, environment.width));
  const std::uint32_t bottom = std::max(top + 1, first(y + 1, height, environment.height));
  glm::vec3 sum(0.0f);
  for (std::uint32_t row = top; row < bottom; ++row) {
    for (std::uint32_t column = left; column < right; ++column) {
      sum += environment.radiance[std::size_t{row} * environment.width + column];
    }
  }
  return sum / static_cast<float>((right - left) * (bottom - top));
}

std::uint8_t srgb(float linear) {
  const float value =
      linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

}  // namespace

std::vector<std::uint8_t> environment_thumbnail(const scene::Environment& environment) {
  std::vector<glm::vec3> pixels;
  float log_sum = 0.0f;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      pixels.push_back(mean_at(environment, x, y));
      log_sum += std::log(luminance(pixels.back()) + 1e-4f);
    }
  }
  // The geometric mean becomes a middle grey.
  const float exposure = 0.35f / std::exp(log_sum / static_cast<float>(pixels.size()));
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * pixels.size());
  for (const glm::vec3& pixel : pixels) {
    const glm::vec3 exposed = exposure * pixel;
    const glm::vec3 mapped = exposed / (1.0f + luminance(exposed));
    for (int c = 0; c < 3; ++c) rgba.push_back(srgb(mapped[c]));
    rgba.push_back(255);
  }
  return stream::encode_png({.width = width, .height = height, .rgba = rgba});
}

}  // namespace heliograph::session
