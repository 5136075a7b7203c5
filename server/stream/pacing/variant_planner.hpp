#pragma once

#include <chrono>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// What one viewer requests for the next frame.
struct RequestedVariant {
  EncodingVariant variant;
  bool ready = false;                    // the frame could be sent at once
  std::optional<VideoPosition> decoder;  // the last video frame that the viewer decoded
  double budget = std::numeric_limits<double>::infinity();  // bytes per video frame
};

/// One encoding of a frame.
struct VariantRequest {
  EncodingVariant variant;
  bool key = false;                                            // the video needs a key frame
  double max_bytes = std::numeric_limits<double>::infinity();  // average, per video frame
};

/// Chooses the variants in which a frame is encoded. A viewer that cannot continue its video,
/// because it is new or missed a frame, costs the others little: their video gets a key frame at
/// most every `min_key_interval`, and until then the viewer gets JPEGs. No I/O and no clock.
class VariantPlanner {
 public:
  static constexpr std::chrono::seconds min_key_interval{2};

  struct Plan {
    std::vector<EncodingVariant> assigned;  // one per request
    std::vector<VariantRequest> requests;
  };
  /// Encodes nothing for viewers that are not ready.
  Plan plan(const std::vector<RequestedVariant>& requests, Clock::time_point now) const;

  /// Records what was encoded, so that viewers can continue a video.
  void published(const EncodedFrame& frame, Clock::time_point now);

  /// The JPEG for viewers of a video that cannot continue it.
  static EncodingVariant jpeg_fallback(const EncodingVariant& video);

 private:
  struct Video {
    VideoPosition newest;
    Clock::time_point key_at;
  };
  bool in_step(const RequestedVariant& request, const EncodingVariant& variant) const;

  std::map<EncodingVariant, Video> videos_;
};

}  // namespace heliograph::stream
