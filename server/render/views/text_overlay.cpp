#include "render/views/text_overlay.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace heliograph::render {
namespace {

constexpr std::uint32_t glyph_width = 6;    // pixels
constexpr std::uint32_t glyph_height = 13;  // pixels
constexpr std::uint32_t margin = 4;         // pixels around the text
constexpr char first_glyph = ' ';
constexpr char last_glyph = '~';
/// Images of more rows than this show the text twice as large.
constexpr std::uint32_t rows_of_small_text = 800;

/// Rows from top to bottom, bit 7 is the leftmost pixel. From the X Window System's misc-fixed
/// 6x13: "Public domain font. Share and enjoy."
constexpr std::uint8_t glyphs[][glyph_height] = {
#include "render/views/font_6x13.inc"
};

std::vector<std::string> broken_lines(std::string_view text, std::size_t columns) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min({text.find('\n'), text.size(), columns});
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
    if (text.starts_with('\n')) text.remove_prefix(1);
  }
  return lines;
}

bool glyph_pixel(char character, std::uint32_t x, std::uint32_t y) {
  const bool known = character >= first_glyph && character <= last_glyph;
  const auto index = static_cast<std::size_t>((known ? character : '?') - first_glyph);
  return glyphs[index][y] >> (7 - x) & 1;
}

}  // namespace

void draw_text(std::string_view text, std::vector<std::uint8_t>& rgba, std::uint32_t width,
               std::uint32_t height) {
  const std::uint32_t scale = height > rows_of_small_text ? 2 : 1;
  const std::uint32_t columns =
      width / scale < 2 * margin + glyph_width ? 0 : (width / scale - 2 * margin) / glyph_width;
  if (text.empty() || columns == 0) return;
  const std::vector<std::string> lines = broken_lines(text, columns);
  std::size_t longest = 0;
  for (const std::string& line : lines) longest = std::max(longest, line.size());
  const std::uint32_t box_width =
      scale * (static_cast<std::uint32_t>(longest) * glyph_width + 2 * margin);
  const std::uint32_t box_height = std::min(
      height, scale * (static_cast<std::uint32_t>(lines.size()) * glyph_height + 2 * margin));
  for (std::uint32_t y = 0; y < box_height; ++y) {
    for (std::uint32_t x = 0; x < box_width; ++x) {
      const std::uint32_t column = x / scale - margin;  // wraps around within the margin
      const std::uint32_t row = y / scale - margin;
      bool lit = false;
      if (x / scale >= margin && y / scale >= margin && row / glyph_height < lines.size()) {
        const std::string& line = lines[row / glyph_height];
        const std::size_t index = column / glyph_width;
        lit = index < line.size() &&
              glyph_pixel(line[index], column % glyph_width, row % glyph_height);
      }
      std::uint8_t* const pixel = &rgba[(std::size_t{y} * width + x) * 4];
      for (int channel = 0; channel < 3; ++channel) {
        pixel[channel] = lit ? 255 : static_cast<std::uint8_t>(pixel[channel] / 4);
      }
    }
  }
}

}  // namespace heliograph::render
