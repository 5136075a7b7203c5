// Whatever bytes come: a picture or an ImportError. PNG, JPEG, WebP, Radiance and OpenEXR, chosen
// by how the file begins.
#include <vector>

#include "scene/exr.hpp"
#include "scene/image_decoder.hpp"
#include "scene/import.hpp"
#include "scene/radiance.hpp"

using namespace heliograph;

namespace {

constexpr std::uint64_t most_pixels = 1 << 18;

void decode_picture(std::span<const std::uint8_t> file) {
  const scene::ImageSize size = scene::probe_image(file);
  if (std::uint64_t{size.width} * size.height > most_pixels) return;
  std::vector<std::uint8_t> rgba(std::size_t{size.width} * size.height * 4);
  scene::decode_image(file, size, rgba);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> file(data, size);
  try {
    if (scene::is_exr(file)) {
      scene::decode_exr(file, most_pixels);
    } else if (size > 1 && data[0] == '#' && data[1] == '?') {
      scene::decode_radiance(file, most_pixels);
    } else {
      decode_picture(file);
    }
  } catch (const scene::ImportError&) {
  }
  return 0;
}
