#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// Frames in flight to any viewer without its stream.ack.
inline constexpr std::uint32_t ack_window = 2;
/// Maximum, for viewers with a long round trip.
inline constexpr std::uint32_t max_ack_window = 8;

/// Number of frames that may be in flight to one viewer: two if acknowledgements return quickly.
/// With a long round trip two frames would limit the frame rate, so the window grows to the number
/// of frame intervals in a round trip, as long as frames arrive no later than a frame that is alone
/// in flight. On a link of low bandwidth, or with a slow viewer, frames queue behind each other,
/// and the window stays at two. No I/O and no clock: callers pass the time.
class AckWindow {
 public:
  struct Arrival {
    std::chrono::microseconds delay{0};  // send to acknowledgement, minus processing in the client
    std::chrono::microseconds interval{0};  // shortest possible frame interval
    std::size_t ahead = 0;                  // frames in flight when it was sent
  };
  void arrived(const Arrival& arrival, Clock::time_point now);

  std::size_t size() const { return size_; }

 private:
  double unqueued_delay_ = 0.0;  // microseconds, of a frame that is alone in flight; 0: not known
  std::size_t size_ = ack_window;
  int in_time_ = 0;  // arrivals in time since the last change, of frames that filled the window
  int late_ = 0;
  Clock::time_point may_grow_at_;
};

}  // namespace heliograph::stream
