#include "scene/image/radiance.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "scene/image/image_size.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using Pixel = std::array<std::uint8_t, 4>;  // red, green, blue, exponent

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t next() {
    if (position_ == bytes_.size()) throw ImportError("is truncated: its data ends early");
    return bytes_[position_++];
  }

  Pixel next_pixel() { return {next(), next(), next(), next()}; }

  std::string next_line() {
    constexpr std::size_t max_line_length = 4096;
    std::string line;
    for (std::uint8_t byte = next(); byte != '\n'; byte = next()) {
      if (line.size() == max_line_length) throw ImportError("has a damaged header");
      line += static_cast<char>(byte);
    }
    return line;
  }

  std::size_t left() const { return bytes_.size() - position_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

ImageSize read_header(ByteReader& reader) {
  const std::string first = reader.left() > 2 ? reader.next_line() : "";
  if (first != "#?RADIANCE" && first != "#?RGBE") throw ImportError("is not a Radiance .hdr file");
  for (std::string line = reader.next_line(); !line.empty(); line = reader.next_line()) {
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
      throw ImportError("is in a format other than 32-bit_rle_rgbe");
    }
  }
  ImageSize size;
  const std::string resolution = reader.next_line();
  char rest = 0;
  if (std::sscanf(resolution.c_str(), "-Y %9u +X %9u %c", &size.height, &size.width, &rest) != 2) {
    throw ImportError("has a damaged header or rows in an unusual order");
  }
  constexpr std::uint32_t max_height = largest_image_side / 2;
  if (size.width == 0 || size.height == 0) throw ImportError("has no pixels");
  if (size.width > largest_image_side || size.height > max_height) {
    throw ImportError("is larger than " + std::to_string(largest_image_side) + " x " +
                      std::to_string(max_height) + " pixels");
  }
  return size;
}

// One channel of a row: runs of one value and literal sequences.
void read_channel(ByteReader& reader, std::span<Pixel> row, std::size_t channel) {
  std::size_t x = 0;
  while (x < row.size()) {
    const std::uint8_t code = reader.next();
    const bool is_run = code > 128;
    const std::size_t count = is_run ? code - 128 : code;
    if (count == 0 || count > row.size() - x) throw ImportError("has a damaged row");
    const std::uint8_t value = is_run ? reader.next() : 0;
    for (const std::size_t end = x + count; x < end; ++x) {
      row[x][channel] = is_run ? value : reader.next();
    }
  }
}

// The older encoding: pixel by pixel, where (1, 1, 1, n) repeats the previous pixel.
void read_pixels(ByteReader& reader, std::span<Pixel> row, std::optional<Pixel> first) {
  std::size_t x = 0;
  int shift = 0;
  while (x < row.size()) {
    const Pixel pixel = first ? *first : reader.next_pixel();
    first.reset();
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t count = shift < 24 ? std::size_t(pixel[3]) << shift : row.size();
      if (x == 0 || count > row.size() - x) throw ImportError("has a damaged row");
      for (const std::size_t end = x + count; x < end; ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
  }
}

void read_row(ByteReader& reader, std::span<Pixel> row) {
  const Pixel start = reader.next_pixel();
  const bool by_channel = row.size() >= 8 && start[0] == 2 && start[1] == 2 && start[2] < 128;
  if (!by_channel) return read_pixels(reader, row, start);
  if ((std::size_t(start[2]) << 8 | start[3]) != row.size()) throw ImportError("has a damaged row");
  for (std::size_t channel = 0; channel < 4; ++channel) read_channel(reader, row, channel);
}

glm::vec3 to_radiance(const Pixel& pixel) {
  if (pixel[3] == 0) return glm::vec3(0.0f);
  return std::ldexp(1.0f, pixel[3] - 136) * glm::vec3(pixel[0], pixel[1], pixel[2]);
}

}  // namespace

Environment decode_radiance(std::span<const std::uint8_t> file, std::uint64_t most_pixels) {
  ByteReader reader(file);
  const ImageSize size = read_header(reader);
  if (std::uint64_t{size.width} * size.height > most_pixels) {
    throw ImportError("has more than " + std::to_string(most_pixels) + " pixels");
  }
  // Every encoding takes at least 4 bytes per row: reject before allocating.
  if (reader.left() < std::size_t(size.height) * 4)
    throw ImportError("is truncated: its data ends early");
  Environment environment{size.width, size.height, {}};
  environment.radiance.reserve(std::size_t(size.width) * size.height);
  std::vector<Pixel> row(size.width);
  for (std::uint32_t y = 0; y < size.height; ++y) {
    read_row(reader, row);
    for (const Pixel& pixel : row) environment.radiance.push_back(to_radiance(pixel));
  }
  return environment;
}

}  // namespace heliograph::scene
