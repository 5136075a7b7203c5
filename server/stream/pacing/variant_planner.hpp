#pragma once

#include <chrono>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// What one viewer could do with the next picture.
struct FormWish {
  Form form;
  bool ready = false;                    // it could be sent at once
  std::optional<VideoPosition> decoder;  // the last frame of a video that the viewer has
  double budget = std::numeric_limits<double>::infinity();  // bytes of a frame of its video
};

/// One encoding of a picture.
struct FormRequest {
  Form form;
  bool key = false;                                            // a video has to begin anew
  double max_bytes = std::numeric_limits<double>::infinity();  // of a video's frame, on average
};

/// Decides in which forms a picture is encoded. A viewer that cannot go on with its video, because
/// it is new or missed a frame, costs the others little: their video gets a key frame at most every
/// `least_key_interval`, and until then the viewer is sent JPEGs. Pure logic.
class FormPlanner {
 public:
  static constexpr std::chrono::seconds least_key_interval{2};

  struct Plan {
    std::vector<Form> assigned;  // for every wish
    std::vector<FormRequest> requests;
  };
  /// Nothing is encoded for viewers who are not ready.
  Plan plan(const std::vector<FormWish>& wishes, Clock::time_point now) const;

  /// Tells what was encoded, so that viewers can go on with a video.
  void published(const EncodedFrame& frame, Clock::time_point now);

  /// The JPEG for viewers of a video who cannot go on with it.
  static Form stand_in(const Form& video);

 private:
  struct Video {
    VideoPosition newest;
    Clock::time_point key_at;
  };
  bool in_step(const FormWish& wish, const Form& form) const;

  std::map<Form, Video> videos_;
};

}  // namespace heliograph::stream
