#include "protocol/settings/color.hpp"

#include <charconv>
#include <cmath>

namespace heliograph::protocol {

std::string color_text(Color color) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text = "#";
  for (int shift = 20; shift >= 0; shift -= 4) text += digits[color.rgb >> shift & 15u];
  return text;
}

std::optional<Color> parse_color(std::string_view text) {
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != 6) return std::nullopt;
  Color color;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, color.rgb, 16);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return color;
}

std::array<float, 3> linear(Color color) {
  const auto channel = [&](int shift) {
    const float value = static_cast<float>(color.rgb >> shift & 255u) / 255.0f;
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace heliograph::protocol
