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

  std::vector<std::uint8_t> encode(const ImageView& image, int quality, int subsampling) {
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    const std::size_t worst = tjBufSize(width, height, subsampling);
    if (buffer.size() < worst) buffer.resize(worst);
    unsigned char* out = buffer.data();
    unsigned long size = buffer.size();
    const int failed = tjCompress2(handle.get(), image.rgba.data(), width, 0, height, TJPF_RGBX,
                                   &out, &size, subsampling, quality, TJFLAG_NOREALLOC);
    if (failed) throw std::runtime_error(std::string("JPEG: ") + tjGetErrorStr2(handle.get()));
    return {out, out + size};
  }
};

JpegEncoder::JpegEncoder() {
  give_back(take());
}

JpegEncoder::~JpegEncoder() = default;

std::unique_ptr<JpegEncoder::State> JpegEncoder::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      std::unique_ptr<State> state = std::move(free_.back());
      free_.pop_back();
      return state;
    }
  }
  auto made = std::make_unique<State>();
  if (!made->handle) throw std::runtime_error("JPEG: cannot initialize libjpeg-turbo");
  return made;
}

void JpegEncoder::give_back(std::unique_ptr<State> state) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(state));
}

std::vector<std::uint8_t> JpegEncoder::encode(const ImageView& image, int quality,
                                              ChromaSampling sampling) {
  if (!image.complete() || image.width > max_side || image.height > max_side) {
    throw std::runtime_error(
        "JPEG: images must be complete and at most 65535 pixels wide and high");
  }
  std::unique_ptr<State> state = take();
  auto bytes =
      state->encode(image, quality, sampling == ChromaSampling::full ? TJSAMP_444 : TJSAMP_420);
  give_back(std::move(state));
  return bytes;
}

}  // namespace heliograph::stream
