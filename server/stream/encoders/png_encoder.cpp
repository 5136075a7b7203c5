#include "stream/encoders/png_encoder.hpp"

#include <png.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace heliograph::stream {
namespace {

struct PngFree {
  void operator()(png_image* image) const { png_image_free(image); }
};

std::vector<std::uint8_t> without_alpha(const ImageView& image) {
  const std::size_t count = std::size_t{image.width} * image.height;
  std::vector<std::uint8_t> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgb[3 * i + channel] = image.rgba[4 * i + channel];
    }
  }
  return rgb;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const ImageView& image, Alpha alpha) {
  if (!image.complete()) throw std::runtime_error("PNG: the image is incomplete");
  std::vector<std::uint8_t> rgb;
  if (alpha == Alpha::ignored) rgb = without_alpha(image);

  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = alpha == Alpha::kept ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png.flags = PNG_IMAGE_FLAG_FAST;
  const std::unique_ptr<png_image, PngFree> cleanup(&png);

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::uint8_t> file(size);
  const std::uint8_t* const pixels = alpha == Alpha::kept ? image.rgba.data() : rgb.data();
  if (!png_image_write_to_memory(&png, file.data(), &size, 0, pixels, 0, nullptr)) {
    throw std::runtime_error(std::string("PNG: ") + png.message);
  }
  file.resize(size);
  return file;
}

}  // namespace heliograph::stream
