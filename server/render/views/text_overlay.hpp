#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace heliograph::render {

/// Draws lines of text into the upper left corner of an image of four bytes a pixel, light on a
/// dark box. Long lines are broken, what has no room is left out, characters outside ASCII are
/// shown as
/// "?". Empty text draws nothing.
void draw_text(std::string_view text, std::vector<std::uint8_t>& rgba, std::uint32_t width,
               std::uint32_t height);

}  // namespace heliograph::render
