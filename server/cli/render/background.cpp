#include "cli/render/background.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace heliograph::cli {
namespace {

constexpr std::uint32_t most_samples = 64;  // of the coverage: enough for 8 bits of alpha

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

Background::Background(const std::string& text) {
  if (text == "sky") return;
  if (text == "blurred" || text == "transparent") {
    kind_ = text == "blurred" ? Kind::blurred : Kind::transparent;
    return;
  }
  kind_ = Kind::color;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const bool marked = text.size() == 7 && text[0] == '#';
  const auto parsed = marked ? std::from_chars(text.data() + 1, end, rgb, 16)
                             : std::from_chars_result{text.data(), std::errc::invalid_argument};
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    throw std::invalid_argument("--background " + text +
                                ": must be sky, blurred, transparent or a colour such as #ffffff");
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    color_[i] = to_linear(static_cast<float>(rgb >> (16 - 8 * i) & 255) / 255.0f);
  }
}

void Coverage::add(render::Renderer& renderer, const render::Frame& frame) {
  if (frame.samples <= samples_) *this = {};
  samples_ = frame.samples;
  if (count_ == most_samples) return;
  const auto motion = renderer.capture("gbuffer.motion");
  if (!motion) {
    throw std::runtime_error("--background: these frames do not know what surfaces cover: " +
                             motion.error().message);
  }
  sum_.resize(motion->rgba.size() / 4);
  // The fourth channel is the depth: 0 where nothing is.
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += motion->rgba[4 * i + 3] > 0 ? 1 : 0;
  ++count_;
}

std::vector<float> Coverage::mean() const {
  std::vector<float> mean = sum_;
  for (float& value : mean) value /= static_cast<float>(count_);
  return mean;
}

void put_background(std::span<std::uint8_t> rgba, const std::vector<float>& coverage,
                    const Background& background) {
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    const std::span<std::uint8_t, 4> pixel = rgba.subspan(4 * i).first<4>();
    const float brightest = static_cast<float>(std::max({pixel[0], pixel[1], pixel[2]})) / 255.0f;
    const float alpha = std::max(coverage[i], to_linear(brightest));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float shown = to_linear(static_cast<float>(pixel[channel]) / 255.0f);
      const float value = background.is_transparent()
                              ? shown / std::max(alpha, 1e-6f)
                              : shown + (1.0f - alpha) * background.color()[channel];
      pixel[channel] = to_byte(to_srgb(std::min(value, 1.0f)));
    }
    pixel[3] = background.is_transparent() ? to_byte(alpha) : 255;
  }
}

}  // namespace heliograph::cli
