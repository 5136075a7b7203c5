#include "scene/image_decoder.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "scene/import.hpp"

namespace {

// A small PNG can inflate to gigabytes. stb_image has no limit of its own, so each decoding thread
// states here how large a single block may grow.
thread_local std::size_t largest_block = 0;

void* allocate_block(std::size_t size) {
  return size > largest_block ? nullptr : std::malloc(size);
}

void* resize_block(void* block, std::size_t size) {
  return size > largest_block ? nullptr : std::realloc(block, size);
}

}  // namespace

#define STBI_MALLOC(size) allocate_block(size)
#define STBI_REALLOC(block, size) resize_block(block, size)
#define STBI_FREE(block) std::free(block)
#define STBI_MAX_DIMENSIONS 8192
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_NO_FAILURE_STRINGS
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace heliograph::scene {
namespace {

static_assert(STBI_MAX_DIMENSIONS == largest_image_side);

struct FreeBlock {
  void operator()(void* block) const { std::free(block); }
};

// Feeds stb_image and notes when it asks for bytes that are not there: it fills the gap of a cut
// JPEG with zeros and calls that success.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool ran_dry() const { return ran_dry_; }

  static stbi_io_callbacks callbacks() {
    return {[](void* self, char* target, int size) {
              return static_cast<ByteSource*>(self)->read(target, size);
            },
            [](void* self, int count) { static_cast<ByteSource*>(self)->skip(count); },
            [](void* self) { return static_cast<int>(static_cast<ByteSource*>(self)->at_end()); }};
  }

 private:
  bool at_end() const { return position_ == bytes_.size(); }

  int read(char* target, int size) {
    const std::size_t count = std::min<std::size_t>(size, bytes_.size() - position_);
    if (count == 0 && size > 0) ran_dry_ = true;
    std::memcpy(target, bytes_.data() + position_, count);
    position_ += count;
    return static_cast<int>(count);
  }

  void skip(int count) {
    const std::size_t left = bytes_.size() - position_;
    if (count < 0 || static_cast<std::size_t>(count) > left) ran_dry_ = true;
    position_ += std::min<std::size_t>(std::max(count, 0), left);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  bool ran_dry_ = false;
};

bool is_png(std::span<const std::uint8_t> file) {
  static constexpr std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return file.size() >= sizeof signature &&
         std::memcmp(file.data(), signature, sizeof signature) == 0;
}

bool is_jpeg(std::span<const std::uint8_t> file) {
  return file.size() >= 3 && file[0] == 0xff && file[1] == 0xd8 && file[2] == 0xff;
}

}  // namespace

ImageSize probe_image(std::span<const std::uint8_t> file) {
  if (!is_png(file) && !is_jpeg(file)) throw ImportError("is neither PNG nor JPEG");
  largest_block = 1 << 20;
  ByteSource source(file);
  const stbi_io_callbacks callbacks = ByteSource::callbacks();
  int width = 0;
  int height = 0;
  int channels = 0;
  if (!stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels)) {
    throw ImportError("has a damaged header, no pixels or too many");
  }
  const int limit = static_cast<int>(largest_image_side);
  if (width <= 0 || height <= 0) throw ImportError("has no pixels");
  if (width > limit || height > limit) {
    throw ImportError("is " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels, more than " + std::to_string(limit) + " a side");
  }
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void decode_image(std::span<const std::uint8_t> file, ImageSize size,
                  std::span<std::uint8_t> rgba) {
  // 16-bit RGBA takes 8 bytes a pixel; inflating doubles its block as it grows.
  const std::size_t padded = std::size_t(size.width + 32) * (size.height + 32);
  largest_block = 24 * padded + (std::size_t(1) << 16);
  ByteSource source(file);
  const stbi_io_callbacks callbacks = ByteSource::callbacks();
  int width = 0;
  int height = 0;
  int channels = 0;
  const std::unique_ptr<stbi_uc, FreeBlock> pixels(
      stbi_load_from_callbacks(&callbacks, &source, &width, &height, &channels, 4));
  if (!pixels) throw ImportError("cannot be decoded: its data is damaged or cut");
  if (source.ran_dry()) throw ImportError("is cut: its data ends early");
  if (static_cast<std::uint32_t>(width) != size.width ||
      static_cast<std::uint32_t>(height) != size.height) {
    throw ImportError("changes its size between header and data");
  }
  std::memcpy(rgba.data(), pixels.get(), std::size_t(size.width) * size.height * 4);
}

}  // namespace heliograph::scene
