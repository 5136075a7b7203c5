#include "scene/image/png_decoder.hpp"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <string>
#include <vector>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

constexpr std::size_t signature_size = 8;
constexpr std::size_t header_size = signature_size + 8 + 13;

struct Input {
  std::span<const std::uint8_t> left;
  char reason[96] = "damaged data";
  bool too_much_data = false;
};

void read_bytes(png_structp png, png_bytep target, png_size_t count) {
  Input& input = *static_cast<Input*>(png_get_io_ptr(png));
  if (count > input.left.size()) png_error(png, "the data ends early");
  std::memcpy(target, input.left.data(), count);
  input.left = input.left.subspan(count);
}

[[noreturn]] void fail(png_structp png, png_const_charp message) {
  Input& input = *static_cast<Input*>(png_get_error_ptr(png));
  std::strncpy(input.reason, message, sizeof input.reason - 1);
  png_longjmp(png, 1);
}

/// All warnings are harmless, but one may hide data of any size.
void note_warning(png_structp png, png_const_charp message) {
  Input& input = *static_cast<Input*>(png_get_error_ptr(png));
  if (std::strstr(message, "Too much image data")) input.too_much_data = true;
}

// Converts every format to 8-bit RGBA.
void request_rgba(png_structp png) {
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
}

// libpng reports errors by longjmp: no object with a destructor may live between setjmp and the
// return, so the caller allocates the rows.
bool read_rows(png_structp png, png_infop info, ImageSize size, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  request_rgba(png);
  png_read_update_info(png, info);
  if (png_get_image_width(png, info) != size.width ||
      png_get_image_height(png, info) != size.height ||
      png_get_rowbytes(png, info) != std::size_t(size.width) * 4) {
    png_error(png, "its size differs from its header");
  }
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> file) : input_{file} {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input_, fail, note_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw ImportError("cannot be decoded: no PNG decoder");
    }
    png_set_read_fn(png_, &input_, read_bytes);
    png_set_user_limits(png_, largest_image_side, largest_image_side);
    // Text and profile chunks are not used and must not cost memory.
    png_set_chunk_cache_max(png_, 16);
    png_set_chunk_malloc_max(png_, 1 << 20);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Whether there is more data than the rows need.
  bool has_too_much_data() const { return input_.too_much_data; }

  void read(ImageSize size, png_bytepp rows) {
    if (!read_rows(png_, info_, size, rows)) {
      throw ImportError(std::string("is a damaged PNG: ") + input_.reason);
    }
  }

 private:
  Input input_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

std::uint32_t read_big_endian(const std::uint8_t* bytes) {
  return std::uint32_t(bytes[0]) << 24 | std::uint32_t(bytes[1]) << 16 |
         std::uint32_t(bytes[2]) << 8 | bytes[3];
}

/// Whether the image data inflate to more than `limit` bytes. Chunks have been checked.
bool unpacks_to_more_than(std::span<const std::uint8_t> file, std::uint64_t limit) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return false;
  std::array<std::uint8_t, 65536> scratch;
  std::uint64_t total = 0;
  int state = Z_OK;
  for (auto left = file.subspan(signature_size); left.size() >= 12 && state == Z_OK;) {
    const std::size_t length =
        std::min<std::size_t>(read_big_endian(left.data()), left.size() - 12);
    stream.next_in = const_cast<Bytef*>(left.data() + 8);
    stream.avail_in = static_cast<uInt>(length);
    if (std::memcmp(left.data() + 4, "IDAT", 4) != 0) stream.avail_in = 0;
    while (stream.avail_in > 0 && state == Z_OK && total <= limit) {
      stream.next_out = scratch.data();
      stream.avail_out = scratch.size();
      state = inflate(&stream, Z_NO_FLUSH);
      total += scratch.size() - stream.avail_out;
    }
    if (total > limit) break;
    left = left.subspan(length + 12);
  }
  inflateEnd(&stream);
  return total > limit;
}

}  // namespace

bool is_png(std::span<const std::uint8_t> file) {
  return file.size() >= signature_size && png_sig_cmp(file.data(), 0, signature_size) == 0;
}

ImageSize probe_png(std::span<const std::uint8_t> file) {
  if (file.size() < header_size || std::memcmp(file.data() + signature_size + 4, "IHDR", 4) != 0) {
    throw ImportError("has a damaged PNG header");
  }
  const std::uint8_t* size = file.data() + signature_size + 8;
  return {read_big_endian(size), read_big_endian(size + 4)};
}

void decode_png(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba) {
  std::vector<png_bytep> rows(size.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = rgba.data() + y * size.width * 4;
  Reader reader(file);
  reader.read(size, rows.data());
  // Some encoders write a few bytes too many.
  const std::uint64_t needed = (std::uint64_t(size.width) * 8 + 1) * size.height;
  if (reader.has_too_much_data() && unpacks_to_more_than(file, 2 * needed + 65536)) {
    throw ImportError("is a damaged PNG: its data unpack to far more than its size");
  }
}

}  // namespace heliograph::scene
