#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace heliograph::protocol {

/// A colour as displays show it: sRGB of eight bits a channel.
struct Color {
  std::uint32_t rgb = 0;  ///< 0xrrggbb

  bool operator==(const Color&) const = default;
};

/// "#rrggbb"
std::string color_text(Color color);
/// Of six hexadecimal digits, with or without '#' before them; nothing for any other text.
std::optional<Color> parse_color(std::string_view text);
/// Linear red, green and blue from 0 to 1 (IEC 61966-2-1).
std::array<float, 3> linear(Color color);

}  // namespace heliograph::protocol
