#pragma once

#include <memory>

#include "stream/encoded_frame.hpp"
#include "stream/form_planner.hpp"
#include "stream/jpeg_encoder.hpp"
#include "stream/picture_view.hpp"

namespace heliograph::stream {

/// Least JPEG quality of a final picture.
inline constexpr int still_quality = 95;

/// Encodes the pictures of one session in the forms that its viewers want. What it gives has its
/// payload, its form, and the members of the header that tell about them. One thread at a time.
class PictureEncoder {
 public:
  /// `jpeg` is used by the same thread.
  explicit PictureEncoder(JpegEncoder& jpeg) : jpeg_(jpeg) {}

  /// A picture out of many. @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode(const PictureView& picture, const FormRequest& request);
  /// The picture that stays: JPEG with all its colour, of `quality` or better, or PNG.
  /// @throws std::runtime_error
  std::shared_ptr<EncodedFrame> encode_still(const PictureView& picture,
                                             protocol::StillFormat format, int quality);

 private:
  JpegEncoder& jpeg_;
};

}  // namespace heliograph::stream
