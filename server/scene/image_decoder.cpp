#include "scene/image_decoder.hpp"

#include <string>

#include "scene/import.hpp"
#include "scene/jpeg_decoder.hpp"
#include "scene/png_decoder.hpp"

namespace heliograph::scene {

ImageSize probe_image(std::span<const std::uint8_t> file) {
  if (!is_png(file) && !is_jpeg(file)) throw ImportError("is neither PNG nor JPEG");
  const ImageSize size = is_png(file) ? probe_png(file) : probe_jpeg(file);
  if (size.width == 0 || size.height == 0) throw ImportError("has no pixels");
  if (size.width > largest_image_side || size.height > largest_image_side) {
    throw ImportError("is " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                      " pixels, more than " + std::to_string(largest_image_side) + " a side");
  }
  return size;
}

void decode_image(std::span<const std::uint8_t> file, ImageSize size,
                  std::span<std::uint8_t> rgba) {
  if (rgba.size() < std::size_t(size.width) * size.height * 4) throw ImportError("has no room");
  (is_png(file) ? decode_png : decode_jpeg)(file, size, rgba);
}

}  // namespace heliograph::scene
