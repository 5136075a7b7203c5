#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "stream/encoded_frame.hpp"

namespace heliograph::stream {

/// An acknowledged moving frame.
struct Arrival {
  std::uint64_t bytes = 0;
  EncodingVariant variant;
  std::chrono::microseconds delay{0};     // send to acknowledgement, minus processing in the client
  std::chrono::microseconds interval{0};  // shortest possible frame interval, apart from the link
};

/// Adapts the moving frames of one viewer to its network link. Derives a byte budget per frame from
/// acknowledgements: multiplicative decrease as soon as they are late, additive increase while they
/// are in time (AIMD), with half a second between two changes and longer after a decrease.
///
/// Late is relative to the delay of an empty frame. That base delay does not include queueing: it
/// is extrapolated from the delays of larger and smaller frames, which every decrease provides. If
/// smaller frames do not arrive sooner, the round trip itself is long, and the decrease is undone.
/// No I/O and no clock: callers pass the time.
class LinkController {
 public:
  void arrived(const Arrival& arrival, Clock::time_point now);

  /// The variant for a viewer that requests `requested`, for frames of `pixels`: quality is reduced
  /// first, then size. Stores the chosen level for hysteresis.
  EncodingVariant choose(const EncodingVariant& requested, std::uint64_t pixels);
  /// The variant of a refining frame of a static view: full size, of less quality on a slow link.
  EncodingVariant choose_refining(const EncodingVariant& requested) const;
  /// Whether `made`, a JPEG, is what some link would be given of a frame for which `requested` was
  /// asked: the choice may have gone on to another one since the frame was made.
  static bool may_choose(const EncodingVariant& requested, const EncodingVariant& made);

  /// Bytes per frame; infinite while nothing limits it.
  double budget() const { return budget_; }
  /// Estimated delay of an empty frame.
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
  void evaluate_decrease();
  std::size_t jpeg_level(const EncodingVariant& requested) const;
  std::size_t video_level(std::uint64_t pixels) const;

  double base_ = 0.0;  // microseconds
  double budget_ = unlimited;
  double unit_bytes_ = 0.0;  // of a JPEG whose relative_bytes() is 1; smoothed
  std::size_t level_ = 0;
  bool late_ = false;  // whether the last arrival was late
  Mean now_;           // of consecutive arrivals that were late, or in time
  Mean before_;        // before the last decrease, until it is evaluated
  double budget_before_ = unlimited;
  bool evaluating_ = false;
  Clock::time_point settled_at_;  // earlier arrivals were sent before the last change
  Clock::time_point next_change_;
  Clock::time_point next_increase_;
};

}  // namespace heliograph::stream
