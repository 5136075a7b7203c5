#pragma once

#include <map>
#include <memory>

#include "stream/encoded_frame.hpp"
#include "stream/encoders/h264_encoder.hpp"
#include "stream/encoders/image_scaler.hpp"
#include "stream/encoders/image_view.hpp"
#include "stream/encoders/jpeg_encoder.hpp"
#include "stream/pacing/variant_planner.hpp"

namespace heliograph::stream {

/// Minimum JPEG quality of a final image.
inline constexpr int still_quality = 95;

/// Encodes the frames of one session in the variants that its viewers need. Sets the payload, the
/// variant, and the members of the header that describe them. One thread at a time.
class FrameEncoder {
 public:
  /// `jpeg` is used by the same thread.
  explicit FrameEncoder(JpegEncoder& jpeg) : jpeg_(jpeg) {}

  /// A moving frame. Where the image is too small for a video it becomes the JPEG fallback.
  /// @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode(const ImageView& image, const VariantRequest& request);
  /// A moving frame that the device has encoded.
  static std::shared_ptr<EncodedFrame> wrap_jpeg(std::uint32_t width, std::uint32_t height,
                                                 const EncodingVariant& variant,
                                                 std::vector<std::uint8_t> bytes);
  /// The final image of a static view: JPEG without chroma subsampling, of `quality` or better, or
  /// PNG. @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode_still(const ImageView& image, protocol::StillFormat format,
                                             int quality);

 private:
  /// One video stream; a change of the image size starts a new one.
  struct Video {
    std::unique_ptr<H264Encoder> encoder;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    VideoPosition next;
    Clock::time_point used_at;
  };

  std::shared_ptr<EncodedFrame> encode_jpeg(const ImageView& image, const EncodingVariant& variant);
  std::shared_ptr<EncodedFrame> encode_video(const ImageView& image, const VariantRequest& request);
  Video& video_for(const EncodingVariant& variant, const ImageView& image);

  JpegEncoder& jpeg_;
  ImageScaler scaler_;
  std::map<EncodingVariant, Video> videos_;
  std::uint64_t video_count_ = 0;
};

}  // namespace heliograph::stream
