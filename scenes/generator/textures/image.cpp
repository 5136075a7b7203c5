#include "scenes/generator/textures/image.hpp"

#include <png.h>

#include <stdexcept>
#include <string>

namespace heliograph::scenes {

std::vector<std::uint8_t> encode_png(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = png_uint_32(image.width);
  header.height = png_uint_32(image.height);
  header.format = image.channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(header));
  size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0,
                                 nullptr)) {
    throw std::runtime_error(std::string("cannot encode a PNG: ") + header.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace heliograph::scenes
