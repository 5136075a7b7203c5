#include "stream/encoders/webp_encoder.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace heliograph::stream {
namespace {

WebPConfig webp_config(int quality) {
  WebPConfig config;
  if (!WebPConfigInit(&config)) throw std::runtime_error("WebP: another version of the library");
  config.quality = static_cast<float>(quality);
  config.method = 4;  // of 0 (fast) to 6 (small)
  return config;
}

/// An image of the library, in its own memory.
class WebpImage {
 public:
  WebpImage(const ImageView& image, Alpha alpha) {
    if (!image.complete()) throw std::runtime_error("WebP: the image is incomplete");
    if (image.width > WEBP_MAX_DIMENSION || image.height > WEBP_MAX_DIMENSION) {
      throw std::runtime_error("WebP: images have at most " + std::to_string(WEBP_MAX_DIMENSION) +
                               " pixels in width and height");
    }
    if (!WebPPictureInit(&pixels_)) {
      throw std::runtime_error("WebP: another version of the library");
    }
    pixels_.use_argb = 1;
    pixels_.width = static_cast<int>(image.width);
    pixels_.height = static_cast<int>(image.height);
    const auto import = alpha == Alpha::kept ? WebPPictureImportRGBA : WebPPictureImportRGBX;
    if (!import(&pixels_, image.rgba.data(), 4 * pixels_.width)) throw std::bad_alloc();
  }
  ~WebpImage() { WebPPictureFree(&pixels_); }
  WebpImage(const WebpImage&) = delete;
  WebpImage& operator=(const WebpImage&) = delete;

  WebPPicture& get() { return pixels_; }

 private:
  WebPPicture pixels_;
};

struct AnimationDeleter {
  void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};

}  // namespace

std::vector<std::uint8_t> encode_webp(const ImageView& image, int quality, Alpha alpha) {
  WebpImage pixels(image, alpha);
  const WebPConfig config = webp_config(quality);
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  const std::unique_ptr<WebPMemoryWriter, void (*)(WebPMemoryWriter*)> cleanup(
      &writer, WebPMemoryWriterClear);
  pixels.get().writer = WebPMemoryWrite;
  pixels.get().custom_ptr = &writer;
  if (!WebPEncode(&config, &pixels.get())) {
    throw std::runtime_error("WebP: error " + std::to_string(pixels.get().error_code));
  }
  return {writer.mem, writer.mem + writer.size};
}

struct WebpAnimation::State {
  std::unique_ptr<WebPAnimEncoder, AnimationDeleter> encoder;
  WebPConfig config;
  Alpha alpha;
  double frame_ms;
  int frames = 0;

  int time() const { return static_cast<int>(std::lround(frames * frame_ms)); }
  void check(int accepted) const {
    if (accepted) return;
    throw std::runtime_error(std::string("WebP: ") + WebPAnimEncoderGetError(encoder.get()));
  }
};

WebpAnimation::WebpAnimation(std::uint32_t width, std::uint32_t height, double fps, int quality,
                             Alpha alpha)
    : state_(std::make_unique<State>()) {
  WebPAnimEncoderOptions options;
  if (!WebPAnimEncoderOptionsInit(&options)) {
    throw std::runtime_error("WebP: another version of the library");
  }
  options.allow_mixed = 0;
  state_->encoder.reset(
      WebPAnimEncoderNew(static_cast<int>(width), static_cast<int>(height), &options));
  if (!state_->encoder) {
    throw std::runtime_error("WebP: an animation cannot have this size");
  }
  state_->config = webp_config(quality);
  state_->alpha = alpha;
  state_->frame_ms = 1000.0 / fps;
}

WebpAnimation::~WebpAnimation() = default;

void WebpAnimation::add(const ImageView& image) {
  WebpImage pixels(image, state_->alpha);
  state_->check(
      WebPAnimEncoderAdd(state_->encoder.get(), &pixels.get(), state_->time(), &state_->config));
  ++state_->frames;
}

std::vector<std::uint8_t> WebpAnimation::finish() {
  state_->check(WebPAnimEncoderAdd(state_->encoder.get(), nullptr, state_->time(), nullptr));
  WebPData data;
  WebPDataInit(&data);
  const std::unique_ptr<WebPData, void (*)(WebPData*)> cleanup(&data, WebPDataClear);
  state_->check(WebPAnimEncoderAssemble(state_->encoder.get(), &data));
  return {data.bytes, data.bytes + data.size};
}

}  // namespace heliograph::stream
