#include "scene/image/ktx2/ktx2_decoder.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "scene/image/ktx2/etc1s.hpp"
#include "scene/image/ktx2/uastc.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 12> identifier = {0xab, 'K',  'T',  'X',  ' ',  '2',
                                                     '0',  0xbb, '\r', '\n', 0x1a, '\n'};

enum class ColorModel : std::uint8_t { etc1s = 163, uastc = 166 };
enum class Packing : std::uint32_t { none = 0, basis_lz = 1, zstandard = 2 };
constexpr std::uint8_t srgb_transfer = 2;

[[noreturn]] void refuse(const std::string& reason) {
  throw ImportError("is a damaged KTX2: " + reason);
}

template <typename T>
T load(ByteSpan bytes, std::size_t offset) {
  if (offset > bytes.size() || sizeof(T) > bytes.size() - offset) refuse("its header is cut");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

ByteSpan part(ByteSpan bytes, std::uint64_t offset, std::uint64_t length, const char* name) {
  if (offset > bytes.size() || length > bytes.size() - offset) {
    refuse(std::string(name) + " reach past its end");
  }
  return bytes.subspan(offset, length);
}

struct Ktx2 {
  ImageSize size;
  ColorModel model;
  Packing packing;
  bool srgb = false;
  bool has_alpha_slice = false;
  std::uint32_t levels = 1;
  ByteSpan global;  // codebooks of ETC1S
  ByteSpan level;   // the largest
};

/// The descriptor of the data format: its first block.
void read_format(ByteSpan descriptor, Ktx2& image) {
  constexpr std::size_t samples = 28;  // offset
  const auto model = load<std::uint8_t>(descriptor, 12);
  image.srgb = load<std::uint8_t>(descriptor, 14) == srgb_transfer;
  if (model != static_cast<std::uint8_t>(ColorModel::etc1s) &&
      model != static_cast<std::uint8_t>(ColorModel::uastc)) {
    throw ImportError("is a KTX2 of a format that KHR_texture_basisu does not permit");
  }
  image.model = static_cast<ColorModel>(model);
  const auto block_bytes = load<std::uint16_t>(descriptor, 10);
  image.has_alpha_slice = block_bytes >= samples - 4 + 2 * 16;
}

Ktx2 read_header(ByteSpan file) {
  Ktx2 image;
  image.size = {load<std::uint32_t>(file, 20), load<std::uint32_t>(file, 24)};
  const auto depth = load<std::uint32_t>(file, 28);
  const auto layers = load<std::uint32_t>(file, 32);
  const auto faces = load<std::uint32_t>(file, 36);
  image.levels = std::max(load<std::uint32_t>(file, 40), 1u);
  const auto packing = load<std::uint32_t>(file, 44);
  if (depth > 1 || layers > 1 || faces != 1) {
    throw ImportError("is a KTX2 of several images, which KHR_texture_basisu does not permit");
  }
  if (image.levels > 32) refuse("it has more levels than there can be");
  read_format(part(file, load<std::uint32_t>(file, 48), load<std::uint32_t>(file, 52),
                   "the format's bytes"),
              image);
  if (packing > static_cast<std::uint32_t>(Packing::zstandard) ||
      (packing == static_cast<std::uint32_t>(Packing::basis_lz)) !=
          (image.model == ColorModel::etc1s)) {
    throw ImportError("is a KTX2 of a compression that KHR_texture_basisu does not permit");
  }
  image.packing = static_cast<Packing>(packing);
  image.global =
      part(file, load<std::uint64_t>(file, 64), load<std::uint64_t>(file, 72), "the global data");
  image.level =
      part(file, load<std::uint64_t>(file, 80), load<std::uint64_t>(file, 88), "the image's bytes");
  return image;
}

void decode_blocks(const Ktx2& image, ByteSpan blocks, std::span<std::uint8_t> rgba) {
  const std::uint32_t columns = (image.size.width + 3) / 4;
  const std::uint32_t rows = (image.size.height + 3) / 4;
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::size_t index = std::size_t(y) * columns + x;
      const auto texels = ktx2::decode_uastc(
          blocks.subspan(index * ktx2::uastc_block_bytes).first<ktx2::uastc_block_bytes>(),
          image.srgb);
      const std::uint32_t width = std::min(4u, image.size.width - 4 * x);
      for (std::uint32_t row = 0; row < std::min(4u, image.size.height - 4 * y); ++row) {
        std::copy_n(texels.data() + 16 * row, 4 * width,
                    rgba.data() + 4 * (std::size_t(4 * y + row) * image.size.width + 4 * x));
      }
    }
  }
}

void decode_uastc_image(const Ktx2& image, std::span<std::uint8_t> rgba) {
  const std::size_t columns = (image.size.width + 3) / 4;
  const std::size_t bytes = columns * ((image.size.height + 3) / 4) * ktx2::uastc_block_bytes;
  if (image.packing == Packing::none) {
    if (image.level.size() < bytes) refuse("its data end early");
    return decode_blocks(image, image.level, rgba);
  }
  // Never more than the blocks of the image, whatever the data unpack to.
  std::vector<std::uint8_t> unpacked(bytes);
  const std::size_t count =
      ZSTD_decompress(unpacked.data(), unpacked.size(), image.level.data(), image.level.size());
  if (ZSTD_isError(count) || count != bytes) refuse("its Zstandard data are invalid");
  decode_blocks(image, unpacked, rgba);
}

void decode_etc1s_image(const Ktx2& image, std::span<std::uint8_t> rgba) {
  constexpr std::size_t header_bytes = 20;
  constexpr std::size_t image_bytes = 20;
  const ByteSpan global = image.global;
  const std::size_t endpoints = header_bytes + image_bytes * image.levels;
  const std::size_t endpoint_bytes = load<std::uint32_t>(global, 4);
  const std::size_t selector_bytes = load<std::uint32_t>(global, 8);
  const std::size_t table_bytes = load<std::uint32_t>(global, 12);
  const std::size_t selectors = endpoints + endpoint_bytes;
  const std::size_t tables = selectors + selector_bytes;
  const ktx2::Etc1sDecoder decoder(
      load<std::uint16_t>(global, 0), part(global, endpoints, endpoint_bytes, "the endpoints"),
      load<std::uint16_t>(global, 2), part(global, selectors, selector_bytes, "the selectors"),
      part(global, tables, table_bytes, "the tables"));
  constexpr std::uint32_t part_of_video = 2;
  if (load<std::uint32_t>(global, header_bytes) & part_of_video) {
    throw ImportError("is a KTX2 video, which KHR_texture_basisu does not permit");
  }
  const auto slice = [&](std::size_t field) {
    return part(image.level, load<std::uint32_t>(global, header_bytes + field),
                load<std::uint32_t>(global, header_bytes + field + 4), "the image's bytes");
  };
  decoder.decode(slice(4), image.size, ktx2::Etc1sDecoder::Channels::color, rgba);
  if (image.has_alpha_slice) {
    decoder.decode(slice(12), image.size, ktx2::Etc1sDecoder::Channels::alpha, rgba);
  }
}

}  // namespace

bool is_ktx2(std::span<const std::uint8_t> file) {
  return file.size() >= identifier.size() &&
         std::equal(identifier.begin(), identifier.end(), file.begin());
}

ImageSize probe_ktx2(std::span<const std::uint8_t> file) {
  return read_header(file).size;
}

void decode_ktx2(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba) {
  const Ktx2 image = read_header(file);
  if (image.size != size) throw ImportError("has a size that differs from its header");
  if (image.model == ColorModel::etc1s) return decode_etc1s_image(image, rgba);
  decode_uastc_image(image, rgba);
}

}  // namespace heliograph::scene
