#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// A frame of the moving picture that arrived.
struct Arrival {
  std::uint64_t bytes = 0;
  Form form;
  std::chrono::microseconds delay{0};     // sending to acknowledgement, less what the client held
  std::chrono::microseconds interval{0};  // how often there could be a picture, whatever the way
};

/// Fits the moving picture of one viewer to the way it takes. Learns from acknowledgements how
/// large a picture may be: less by a factor as soon as they come late, more by a constant step
/// while they come in time, with half a second between two changes and longer after a decrease.
///
/// Late is measured against the time that an empty picture would take. That time is never taken
/// from a queue: it is found by comparing the delays of larger and smaller pictures, which is what
/// every decrease provides. Where smaller pictures do not come sooner, the way itself is long and
/// the decrease is taken back. Pure logic: callers bring the time.
class LinkController {
 public:
  void arrived(const Arrival& arrival, Clock::time_point now);

  /// The form for a viewer who wants `wanted`, of pictures of `pixels`: first quality goes, then
  /// size. Asking changes what the next answer is compared with, so that it does not flicker.
  Form choose(const Form& wanted, std::uint64_t pixels);
  /// The form of a picture that rests but gets better: whole, of less quality on a narrow way.
  Form resting(const Form& wanted) const;

  /// Bytes that a picture may have; infinite as long as nothing limits it.
  double budget() const { return budget_; }
  /// The time that an empty picture would take, as far as it is known.
  std::chrono::microseconds base_delay() const;

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  /// Means over the arrivals since a change took effect; delays in microseconds.
  struct Mean {
    double bytes = 0.0;
    double delay = 0.0;
    int count = 0;
    void add(double more_bytes, double more_delay);
  };

  bool late(const Arrival& arrival) const;
  void lower(Clock::time_point now);
  void judge_decrease();
  std::size_t jpeg_rung(const Form& wanted) const;
  std::size_t video_rung(std::uint64_t pixels) const;

  double base_ = 0.0;  // microseconds
  double budget_ = unlimited;
  double unit_bytes_ = 0.0;  // of a JPEG in the form whose relative size is 1; smoothed
  std::size_t rung_ = 0;
  bool late_ = false;  // the last arrival was
  Mean now_;           // of arrivals that were late, or in time, like the last
  Mean before_;        // the last decrease, while it is not judged
  double budget_before_ = unlimited;
  bool judging_ = false;
  Clock::time_point settled_at_;  // what comes earlier was sent before the last change
  Clock::time_point next_change_;
  Clock::time_point next_increase_;
};

}  // namespace heliograph::stream
