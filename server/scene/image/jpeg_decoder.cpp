#include "scene/image/jpeg_decoder.hpp"

#include <turbojpeg.h>

#include <memory>
#include <string>
#include <string_view>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

struct DestroyDecompressor {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Decompressor = std::unique_ptr<void, DestroyDecompressor>;

Decompressor make_decompressor() {
  Decompressor decompressor(tjInitDecompress());
  if (!decompressor) throw ImportError("cannot be decoded: no JPEG decoder");
  return decompressor;
}

// libjpeg fills missing data with gray and only warns. The one harmless warning is about stray
// bytes between segments, which some cameras write.
bool is_harmless(tjhandle handle) {
  return tjGetErrorCode(handle) == TJERR_WARNING &&
         std::string_view(tjGetErrorStr2(handle)).find("extraneous bytes") !=
             std::string_view::npos;
}

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> file) {
  return file.size() >= 3 && file[0] == 0xff && file[1] == 0xd8 && file[2] == 0xff;
}

ImageSize probe_jpeg(std::span<const std::uint8_t> file) {
  const Decompressor decompressor = make_decompressor();
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(decompressor.get(), file.data(), file.size(), &width, &height,
                          &subsampling, &color_space) != 0 &&
      !is_harmless(decompressor.get())) {
    throw ImportError("has a damaged JPEG header");
  }
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void decode_jpeg(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba) {
  if (probe_jpeg(file) != size) throw ImportError("has a size that differs from its header");
  const Decompressor decompressor = make_decompressor();
  // A progressive JPEG can repeat its scans without limit.
  constexpr int flags = TJFLAG_LIMITSCANS;
  if (tjDecompress2(decompressor.get(), file.data(), file.size(), rgba.data(),
                    static_cast<int>(size.width), 0, static_cast<int>(size.height), TJPF_RGBA,
                    flags) != 0 &&
      !is_harmless(decompressor.get())) {
    throw ImportError(std::string("is a damaged JPEG: ") + tjGetErrorStr2(decompressor.get()));
  }
}

}  // namespace heliograph::scene
