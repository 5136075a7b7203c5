#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// Frames that may be on their way to any viewer without its stream.ack.
inline constexpr std::uint32_t ack_window = 2;
/// The most for one whose way is long.
inline constexpr std::uint32_t longest_ack_window = 8;

/// How many frames may be on their way to one viewer. Two, where acknowledgements come back soon.
/// On a long way two would be all that arrives in a round trip, so there are more: as many as the
/// way holds one interval apart, and only while they come no later than a frame that is alone on
/// the way. On a narrow way, or before a slow viewer, frames wait for each other, and it stays at
/// two. Pure logic: callers bring the time.
class AckWindow {
 public:
  struct Arrival {
    std::chrono::microseconds delay{0};     // sending to acknowledgement, less what the client held
    std::chrono::microseconds interval{0};  // how often there could be a picture
    std::size_t ahead = 0;                  // frames that were on the way when it was sent
  };
  void arrived(const Arrival& arrival, Clock::time_point now);

  std::size_t size() const { return size_; }

 private:
  double alone_ = 0.0;  // microseconds that a frame takes which is alone on the way; 0: not known
  std::size_t size_ = ack_window;
  int in_time_ = 0;  // arrivals since the last change, of frames that filled the window
  int late_ = 0;
  Clock::time_point may_grow_at_;
};

}  // namespace heliograph::stream
