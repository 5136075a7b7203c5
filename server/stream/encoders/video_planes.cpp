#include "stream/encoders/video_planes.hpp"

#include <cstring>

namespace heliograph::stream {
namespace {

// ITU-R BT.709, section 3: Kr = 0.2126, Kb = 0.0722; 219 steps of luma, 224 of colour; times 2^15.
constexpr int shift = 15;
constexpr double unit = (1 << shift) / 255.0;
constexpr int fixed(double value) {
  return static_cast<int>(value < 0 ? value - 0.5 : value + 0.5);
}
constexpr double kr = 0.2126;
constexpr double kb = 0.0722;
constexpr double kg = 1.0 - kr - kb;

constexpr int luma_red = fixed(219 * unit * kr);
constexpr int luma_green = fixed(219 * unit * kg);
constexpr int luma_blue = fixed(219 * unit * kb);
constexpr int luma_offset = (16 << shift) + (1 << (shift - 1));

// Of the sum of four pixels: two bits more.
constexpr int blue_scale_red = fixed(-112 * unit * kr / (1.0 - kb));
constexpr int blue_scale_green = fixed(-112 * unit * kg / (1.0 - kb));
constexpr int full_scale = fixed(112 * unit);
constexpr int red_scale_green = fixed(-112 * unit * kg / (1.0 - kr));
constexpr int red_scale_blue = fixed(-112 * unit * kb / (1.0 - kr));
constexpr int colour_shift = shift + 2;
constexpr int colour_offset = (128 << colour_shift) + (1 << (colour_shift - 1));

std::uint32_t pixel(const std::uint8_t* rgba, std::size_t x) {
  std::uint32_t value;
  std::memcpy(&value, rgba + 4 * x, sizeof value);
  return value;
}

int red_of(std::uint32_t value) {
  return static_cast<int>(value & 255);
}
int green_of(std::uint32_t value) {
  return static_cast<int>(value >> 8 & 255);
}
int blue_of(std::uint32_t value) {
  return static_cast<int>(value >> 16 & 255);
}

void luma_row(const std::uint8_t* rgba, std::size_t width, std::uint8_t* out) {
  for (std::size_t x = 0; x < width; ++x) {
    const std::uint32_t p = pixel(rgba, x);
    const int sum = luma_red * red_of(p) + luma_green * green_of(p) + luma_blue * blue_of(p);
    out[x] = static_cast<std::uint8_t>((sum + luma_offset) >> shift);
  }
}

void colour_row(const std::uint8_t* above, const std::uint8_t* below, std::size_t width,
                std::uint8_t* blue_out, std::uint8_t* red_out) {
  for (std::size_t x = 0; x < width; ++x) {
    const std::uint32_t a = pixel(above, 2 * x);
    const std::uint32_t b = pixel(above, 2 * x + 1);
    const std::uint32_t c = pixel(below, 2 * x);
    const std::uint32_t d = pixel(below, 2 * x + 1);
    const int red = red_of(a) + red_of(b) + red_of(c) + red_of(d);
    const int green = green_of(a) + green_of(b) + green_of(c) + green_of(d);
    const int blue = blue_of(a) + blue_of(b) + blue_of(c) + blue_of(d);
    const int cb = blue_scale_red * red + blue_scale_green * green + full_scale * blue;
    const int cr = full_scale * red + red_scale_green * green + red_scale_blue * blue;
    blue_out[x] = static_cast<std::uint8_t>((cb + colour_offset) >> colour_shift);
    red_out[x] = static_cast<std::uint8_t>((cr + colour_offset) >> colour_shift);
  }
}

}  // namespace

void to_video_planes(const ImageView& image, const VideoPlanes& planes) {
  const std::size_t width = image.width & ~1u;
  const std::size_t height = image.height & ~1u;
  const std::size_t row_bytes = std::size_t{4} * image.width;
  const std::uint8_t* const rgba = image.rgba.data();
  for (std::size_t y = 0; y < height; y += 2) {
    const std::uint8_t* const above = rgba + y * row_bytes;
    const std::uint8_t* const below = above + row_bytes;
    luma_row(above, width, planes.luma.samples + y * planes.luma.stride);
    luma_row(below, width, planes.luma.samples + (y + 1) * planes.luma.stride);
    colour_row(above, below, width / 2, planes.blue.samples + y / 2 * planes.blue.stride,
               planes.red.samples + y / 2 * planes.red.stride);
  }
}

}  // namespace heliograph::stream
