#include "stream/encoders/jpeg_encoder.hpp"

#include <turbojpeg.h>

#include <stdexcept>
#include <string>

namespace heliograph::stream {
namespace {

struct HandleDeleter {
  void operator()(void* handle) const { tjDestroy(handle); }
};

constexpr int max_side = 65500;

}  // namespace

struct JpegEncoder::State {
  std::unique_ptr<void, HandleDeleter> handle{tjInitCompress()};
  std::vector<std::uint8_t> buffer;  // as large as the largest encoded image so far
};

JpegEncoder::JpegEncoder() : state_(std::make_unique<State>()) {
  if (!state_->handle) throw std::runtime_error("JPEG: cannot initialize libjpeg-turbo");
}

JpegEncoder::~JpegEncoder() = default;

std::vector<std::uint8_t> JpegEncoder::encode(const ImageView& image, int quality,
                                              ChromaSampling sampling) {
  if (!image.complete() || image.width > max_side || image.height > max_side) {
    throw std::runtime_error(
        "JPEG: images must be complete and at most 65535 pixels wide and high");
  }
  const int width = static_cast<int>(image.width);
  const int height = static_cast<int>(image.height);
  const int subsampling = sampling == ChromaSampling::full ? TJSAMP_444 : TJSAMP_420;
  const std::size_t worst = tjBufSize(width, height, subsampling);
  if (state_->buffer.size() < worst) state_->buffer.resize(worst);

  unsigned char* out = state_->buffer.data();
  unsigned long size = state_->buffer.size();
  const int failed = tjCompress2(state_->handle.get(), image.rgba.data(), width, 0, height,
                                 TJPF_RGBX, &out, &size, subsampling, quality, TJFLAG_NOREALLOC);
  if (failed) {
    throw std::runtime_error(std::string("JPEG: ") + tjGetErrorStr2(state_->handle.get()));
  }
  return {out, out + size};
}

}  // namespace heliograph::stream
