#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "stream/encoded_frame.hpp"
#include "stream/pacing/ack_window.hpp"
#include "stream/pacing/histogram.hpp"
#include "stream/pacing/link_controller.hpp"

namespace heliograph::stream {

struct PacerTotals {
  std::uint64_t frames = 0;  // taken for sending
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;  // replaced by a newer frame before they were sent
  std::uint64_t acknowledged = 0;
  Histogram round_trips;  // individual samples of round_trip()

  PacerTotals& operator+=(const PacerTotals& more) {
    frames += more.frames;
    bytes += more.bytes;
    dropped += more.dropped;
    acknowledged += more.acknowledged;
    round_trips.add(more.round_trips);
    return *this;
  }
};

/// Decides which frames one viewer gets, and when. There is no queue: one slot holds the latest
/// frame, and a newer one replaces it. A viewer that stops acknowledging has at most a window of
/// frames in flight and one pending. No I/O and no clock: callers pass the time.
class ViewerPacer {
 public:
  /// Whether the viewer's decoder can show `frame` after the frames offered so far.
  bool can_show(const EncodedFrame& frame) const;
  /// Makes `frame` pending; the viewer can show it. Assigns its frame_seq for this viewer.
  void offer(SharedFrame frame);
  /// Discards the pending frame; a video restarts with a key frame.
  void drop_pending();
  /// Counts a frame that this viewer cannot show as dropped.
  void skip();
  /// The pending frame, if it may be sent now; it is in flight from then on.
  struct Taken {
    std::uint32_t frame_seq;
    bool first_after_drop;
    SharedFrame frame;
  };
  std::optional<Taken> take(Clock::time_point now);
  /// An acknowledgement covers all earlier frames. False if the frame is not in flight.
  bool acknowledge(std::uint32_t frame_seq, std::chrono::microseconds held, Clock::time_point now);

  void set_max_rate(double frames_per_second);
  void set_paused(bool paused, Clock::time_point now);
  bool paused() const { return paused_; }

  /// Whether a new frame could be sent at once.
  bool has_room(Clock::time_point now) const;
  /// Likewise of that frame and one more, so long behind it: by then those in flight may be
  /// acknowledged, as soon as they usually are.
  bool has_room_for_two(Clock::time_point now, Clock::duration apart) const;
  bool frame_pending() const { return pending_ != nullptr; }
  /// The last video frame offered to the viewer, if the video can continue from it.
  const std::optional<VideoPosition>& decoder() const { return decoder_; }
  /// Whether take() would return a frame.
  bool sendable(Clock::time_point now) const;
  /// When the frame rate limit allows the next frame.
  Clock::time_point next_send() const { return next_send_; }

  /// Since when the oldest frame in flight is unacknowledged, if there is one. The time starts
  /// again when a paused stream is resumed.
  std::optional<Clock::time_point> unacknowledged_since(Clock::time_point now) const {
    if (in_flight_.empty()) return std::nullopt;
    return paused_ ? now : std::max(in_flight_.front().at, resumed_at_);
  }

  const PacerTotals& totals() const { return totals_; }
  std::size_t in_flight() const { return in_flight_.size(); }
  /// Smoothed time from sending to acknowledgement, minus the client's processing time; zero before
  /// the first.
  std::chrono::microseconds round_trip() const { return round_trip_; }
  /// Smoothed throughput in bytes per second while frames are in flight; zero before the first.
  double goodput() const { return goodput_; }
  /// Chooses the variant of moving frames for the link to this viewer.
  LinkController& link() { return link_; }
  const LinkController& link() const { return link_; }

 private:
  struct Sent {
    std::uint32_t frame_seq;
    std::uint64_t bytes;
    Clock::time_point at;
    EncodingVariant variant;
    std::chrono::microseconds rendering;
    std::size_t ahead;  // frames already in flight
    bool measurable;    // a moving frame behind only such frames
  };

  bool window_open() const { return in_flight_.size() < window_.size(); }
  void measure(const Sent& sent, std::chrono::microseconds held, Clock::time_point now);

  SharedFrame pending_;
  std::optional<VideoPosition> decoder_;
  std::uint32_t offered_ = 0;      // frame_seq of the pending frame
  std::uint32_t last_number_ = 0;  // of any frame, including skipped ones
  bool dropped_since_taken_ = false;
  std::deque<Sent> in_flight_;
  bool paused_ = false;
  Clock::time_point resumed_at_;
  std::chrono::microseconds min_interval_{0};
  Clock::time_point next_send_;
  PacerTotals totals_;
  std::chrono::microseconds round_trip_{0};
  std::chrono::microseconds in_flight_for_{0};  // a frame, smoothed; with the client's time
  double goodput_ = 0.0;
  Clock::time_point last_acknowledgement_;
  LinkController link_;
  AckWindow window_;
};

}  // namespace heliograph::stream
