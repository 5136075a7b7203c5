// Arbitrary bytes behind the identifier of KTX2 must give an image of the size that its header
// states, with mip levels, or an ImportError.
#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

#include "scene/image/image_decoder.hpp"
#include "scene/image/ktx2/ktx2_decoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "scene/import_error.hpp"

using namespace heliograph;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::uint64_t most_pixels = 1 << 16;
constexpr std::array<std::uint8_t, 12> identifier = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                                     '0',  0xbb, '\r', '\n', 0x1a, '\n'};
// Of the header, in bytes.
constexpr std::size_t width_at = 20, height_at = 24, level_at = 80, length_at = 88;
constexpr std::size_t header_bytes = 104;

template <class Number>
void put(std::uint8_t* to, Number number) {
  std::memcpy(to, &number, sizeof number);
}

/// Small sizes, and a level that lies in the file: a header of other numbers ends the decoder
/// before it reads any pixel. Others are tested too, in one of 16 mutations.
void repair(std::uint8_t* data, std::size_t size, std::mt19937& random) {
  std::copy(identifier.begin(), identifier.end(), data);
  if (random() % 16 == 0) return;
  if (random() % 4 == 0) put<std::uint32_t>(data + width_at, 1 + random() % 64);
  if (random() % 4 == 0) put<std::uint32_t>(data + height_at, 1 + random() % 64);
  std::uint64_t begin = 0, length = 0;
  std::memcpy(&begin, data + level_at, sizeof begin);
  std::memcpy(&length, data + length_at, sizeof length);
  if (begin > size) put<std::uint64_t>(data + level_at, begin = random() % size);
  if (length > size - begin) put<std::uint64_t>(data + length_at, size - begin);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> file(data, size);
  if (!scene::is_ktx2(file)) return 0;
  try {
    const scene::ImageSize found = scene::probe_image(file);
    if (std::uint64_t{found.width} * found.height > most_pixels) return 0;
    scene::Image image{.width = found.width,
                       .height = found.height,
                       .levels = scene::mip_level_count(found.width, found.height)};
    image.pixels.resize(scene::mip_chain_bytes(found.width, found.height));
    const std::size_t first_level = std::size_t{4} * found.width * found.height;
    scene::decode_image(file, found, std::span(image.pixels).first(first_level));
    scene::fill_mip_chain(image);
  } catch (const scene::ImportError&) {
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, most);
  std::mt19937 random(seed);
  if (mutated >= header_bytes) repair(data, mutated, random);
  return mutated;
}
