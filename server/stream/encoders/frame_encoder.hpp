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

/// Least JPEG quality of a final picture.
inline constexpr int still_quality = 95;

/// Encodes the pictures of one session in the forms that its viewers want. What it gives has its
/// payload, its form, and the members of the header that tell about them. One thread at a time.
class PictureEncoder {
 public:
  /// `jpeg` is used by the same thread.
  explicit PictureEncoder(JpegEncoder& jpeg) : jpeg_(jpeg) {}

  /// A picture out of many. A video that cannot be encoded, for instance because the picture is
  /// one pixel wide, is replaced by its stand-in. @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode(const PictureView& picture, const FormRequest& request);
  /// The picture that stays: JPEG with all its colour, of `quality` or better, or PNG.
  /// @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode_still(const PictureView& picture,
                                             protocol::StillFormat format, int quality);

 private:
  /// One video: a new one begins when the size of the picture changes.
  struct Video {
    std::unique_ptr<H264Encoder> encoder;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    VideoPosition next;
    Clock::time_point used_at;
  };

  std::shared_ptr<EncodedFrame> encode_jpeg(const PictureView& picture, const Form& form);
  std::shared_ptr<EncodedFrame> encode_video(const PictureView& picture,
                                             const FormRequest& request);
  Video& video_for(const Form& form, const PictureView& picture);

  JpegEncoder& jpeg_;
  PictureScaler scaler_;
  std::map<Form, Video> videos_;
  std::uint64_t videos_so_far_ = 0;
};

}  // namespace heliograph::stream
