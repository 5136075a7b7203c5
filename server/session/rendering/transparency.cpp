#include "session/rendering/transparency.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace heliograph::session {
namespace {

using nlohmann::json;

// IEC 61966-2-1.
float to_linear(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

float to_srgb(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

}  // namespace

json coverage_settings(CoverageBackground background) {
  const json off{{"enabled", false}};
  const char* const color = background == CoverageBackground::white ? "#ffffff" : "#000000";
  return {
      {"environment", {{"visible", true}}},
      {"background", {{"show", "color"}, {"color", color}}},
      {"lighting",
       {{"direct", false},
        {"environment_diffuse", false},
        {"environment_specular", false},
        {"emissive", false}}},
      {"shadows", off},
      {"specular", off},
      {"indirect", off},
      {"ambient", {{"occlusion", false}}},
      {"antialiasing", {{"temporal", false}, {"jitter", true}}},
      {"accumulation",
       {{"enabled", true},
        {"max_samples", coverage_samples},
        {"by_noise", false},
        {"blend_samples", 0}}},
      {"reference", {{"use", "off"}}},
  };
}

std::vector<float> coverage_of(std::span<const float> over_white,
                               std::span<const float> over_black) {
  std::vector<float> coverage(over_white.size() / 4);
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    const float transmitted = over_white[4 * i + 1] - over_black[4 * i + 1];
    coverage[i] = std::clamp(1.0f - transmitted, 0.0f, 1.0f);
  }
  return coverage;
}

void put_background(std::span<std::uint8_t> rgba, std::span<const float> coverage,
                    const std::optional<std::array<float, 3>>& color) {
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    const std::span<std::uint8_t, 4> pixel = rgba.subspan(4 * i).first<4>();
    const float brightest = static_cast<float>(std::max({pixel[0], pixel[1], pixel[2]})) / 255.0f;
    const float alpha = std::max(coverage[i], to_linear(brightest));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float shown = to_linear(static_cast<float>(pixel[channel]) / 255.0f);
      const float value =
          color ? shown + (1.0f - alpha) * (*color)[channel] : shown / std::max(alpha, 1e-6f);
      pixel[channel] = to_byte(to_srgb(std::min(value, 1.0f)));
    }
    pixel[3] = color ? 255 : to_byte(alpha);
  }
}

}  // namespace heliograph::session
