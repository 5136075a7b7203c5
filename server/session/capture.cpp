#include "session/capture.hpp"

#include "stream/jpeg_encoder.hpp"
#include "stream/png_encoder.hpp"

namespace heliograph::session {

std::vector<std::uint8_t> encode_capture(const stream::PictureView& picture, CaptureFormat format) {
  if (format == CaptureFormat::png) return stream::encode_png(picture);
  constexpr int quality = 90;
  return stream::JpegEncoder().encode(picture, quality, stream::ChromaSampling::full);
}

}  // namespace heliograph::session
