#include "scene/image/webp_decoder.hpp"

#include <webp/decode.h>

#include <cstring>

#include "scene/import_error.hpp"

namespace heliograph::scene {

bool is_webp(std::span<const std::uint8_t> file) {
  return file.size() >= 12 && std::memcmp(file.data(), "RIFF", 4) == 0 &&
         std::memcmp(file.data() + 8, "WEBP", 4) == 0;
}

ImageSize probe_webp(std::span<const std::uint8_t> file) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK) {
    throw ImportError("has a damaged WebP header");
  }
  if (features.has_animation) throw ImportError("is an animated WebP, which is not supported");
  return {static_cast<std::uint32_t>(features.width), static_cast<std::uint32_t>(features.height)};
}

void decode_webp(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba) {
  if (probe_webp(file) != size) throw ImportError("has a size that differs from its header");
  const int stride = static_cast<int>(size.width) * 4;
  if (!WebPDecodeRGBAInto(file.data(), file.size(), rgba.data(), rgba.size(), stride)) {
    throw ImportError("is a damaged WebP");
  }
}

}  // namespace heliograph::scene
