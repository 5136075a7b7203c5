#include "scene/image/image_decoder.hpp"

#include <string>

#include "scene/image/jpeg_decoder.hpp"
#include "scene/image/ktx2/ktx2_decoder.hpp"
#include "scene/image/png_decoder.hpp"
#include "scene/image/webp_decoder.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

ImageSize probe_known_format(std::span<const std::uint8_t> file) {
  if (is_png(file)) return probe_png(file);
  if (is_jpeg(file)) return probe_jpeg(file);
  if (is_webp(file)) return probe_webp(file);
  if (is_ktx2(file)) return probe_ktx2(file);
  throw ImportError("is neither PNG, JPEG, WebP nor KTX2");
}

}  // namespace

ImageSize probe_image(std::span<const std::uint8_t> file) {
  const ImageSize size = probe_known_format(file);
  if (size.width == 0 || size.height == 0) throw ImportError("has no pixels");
  if (size.width > largest_image_side || size.height > largest_image_side) {
    throw ImportError("is " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                      " pixels, more than " + std::to_string(largest_image_side) + " a side");
  }
  return size;
}

void decode_image(std::span<const std::uint8_t> file, ImageSize size,
                  std::span<std::uint8_t> rgba) {
  if (rgba.size() < std::size_t(size.width) * size.height * 4)
    throw ImportError("does not fit the output buffer");
  if (is_png(file)) return decode_png(file, size, rgba);
  if (is_webp(file)) return decode_webp(file, size, rgba);
  if (is_ktx2(file)) return decode_ktx2(file, size, rgba);
  decode_jpeg(file, size, rgba);
}

}  // namespace heliograph::scene
