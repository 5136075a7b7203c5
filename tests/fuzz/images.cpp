// Arbitrary bytes must give an image or an ImportError. PNG, JPEG, WebP, Radiance or OpenEXR,
// chosen by the first bytes of the file.
#include <algorithm>
#include <random>
#include <vector>

#include "scene/image/exr.hpp"
#include "scene/image/image_decoder.hpp"
#include "scene/image/radiance.hpp"
#include "scene/import.hpp"

using namespace heliograph;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::uint64_t most_pixels = 1 << 18;

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// Corrects the checksums of a PNG file's chunks: decoders stop at a wrong one.
void fix_checksums(std::span<std::uint8_t> file) {
  constexpr std::size_t signature = 8, frame = 12;  // length, type and checksum
  for (std::size_t at = signature; at + frame <= file.size();) {
    const std::size_t length = std::size_t{file[at]} << 24 | std::size_t{file[at + 1]} << 16 |
                               std::size_t{file[at + 2]} << 8 | file[at + 3];
    if (length > file.size() - at - frame) return;
    const std::uint32_t crc = crc_of(file.subspan(at + 4, 4 + length));
    for (std::size_t i = 0; i < 4; ++i) {
      file[at + 8 + length + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
    at += frame + length;
  }
}

bool is_png(std::span<const std::uint8_t> file) {
  return file.size() > 8 && file[0] == 0x89 && file[1] == 'P' && file[2] == 'N' && file[3] == 'G';
}

void decode_pixels(std::span<const std::uint8_t> file) {
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
      decode_pixels(file);
    }
  } catch (const scene::ImportError&) {
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, most);
  const std::span<std::uint8_t> file(data, mutated);
  // Wrong checksums are tested too, in one of 16 mutations.
  if (is_png(file) && std::mt19937(seed)() % 16 != 0) fix_checksums(file);
  return mutated;
}
