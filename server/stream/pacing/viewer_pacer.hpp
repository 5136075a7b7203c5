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
  std::uint64_t dropped = 0;  // replaced by a newer one before they could be sent
  std::uint64_t acknowledged = 0;
  Histogram round_trips;  // as round_trip(), one by one

  PacerTotals& operator+=(const PacerTotals& more) {
    frames += more.frames;
    bytes += more.bytes;
    dropped += more.dropped;
    acknowledged += more.acknowledged;
    round_trips.add(more.round_trips);
    return *this;
  }
};

/// Decides what one viewer gets, and when. There is no queue: one slot holds the latest frame, a
/// newer one replaces it. A viewer that stops acknowledging keeps at most a window of frames on the
/// way and one in the slot. Pure logic: callers bring the time.
class ViewerPacer {
 public:
  /// Whether the viewer's decoder can show `frame` after everything it was offered so far.
  bool can_show(const EncodedFrame& frame) const;
  /// Puts a frame that the viewer can show into the slot, numbering it for this viewer.
  void offer(SharedFrame frame);
  /// Empties the slot: what waits is of no interest any more, and no video goes on.
  void withdraw();
  /// Counts a frame that this viewer cannot have.
  void skip();
  /// The waiting frame's number, if the viewer may have it now; it then counts as on its way.
  struct Taken {
    std::uint32_t frame_seq;
    bool first_after_drop;
    SharedFrame frame;
  };
  std::optional<Taken> take(Clock::time_point now);
  /// An acknowledgement covers all earlier frames. False for one that was never sent.
  bool acknowledge(std::uint32_t frame_seq, std::chrono::microseconds held, Clock::time_point now);

  void set_max_rate(double frames_per_second);
  void set_paused(bool paused, Clock::time_point now);
  bool paused() const { return paused_; }

  /// Whether a frame rendered now could be sent at once.
  bool has_room(Clock::time_point now) const;
  bool frame_waiting() const { return waiting_ != nullptr; }
  /// The last frame of a video that the viewer was offered, if it can go on from there.
  const std::optional<VideoPosition>& decoder() const { return decoder_; }
  /// Whether take() would give a frame.
  bool sendable(Clock::time_point now) const;
  /// When the rate limit next lets a frame through.
  Clock::time_point next_turn() const { return next_turn_; }

  /// Since when the viewer owes the acknowledgement of a frame, if it owes one. It owes none while
  /// it is paused, and has all its time again afterwards.
  std::optional<Clock::time_point> unacknowledged_since(Clock::time_point now) const {
    if (on_the_way_.empty()) return std::nullopt;
    return paused_ ? now : std::max(on_the_way_.front().at, resumed_at_);
  }

  const PacerTotals& totals() const { return totals_; }
  std::size_t on_the_way() const { return on_the_way_.size(); }
  /// Smoothed time from sending to acknowledgement, less what the client says it held the frame;
  /// zero before the first.
  std::chrono::microseconds round_trip() const { return round_trip_; }
  /// Smoothed bytes a second that reach the viewer while frames are on their way; zero before any.
  double goodput() const { return goodput_; }
  /// Chooses the form of the moving picture by what the way to this viewer carries.
  LinkController& link() { return link_; }
  const LinkController& link() const { return link_; }

 private:
  struct Sent {
    std::uint32_t frame_seq;
    std::uint64_t bytes;
    Clock::time_point at;
    Form form;
    std::chrono::microseconds rendering;
    std::size_t ahead;  // frames that were on the way already
    bool telling;       // of the moving picture, with only such frames before it on the way
  };

  bool window_open() const { return on_the_way_.size() < window_.size(); }
  void measure(const Sent& sent, std::chrono::microseconds held, Clock::time_point now);

  SharedFrame waiting_;
  std::optional<VideoPosition> decoder_;
  std::uint32_t offered_ = 0;      // number of the waiting frame
  std::uint32_t last_number_ = 0;  // of any frame, skipped ones too
  bool dropped_since_taken_ = false;
  std::deque<Sent> on_the_way_;
  bool paused_ = false;
  Clock::time_point resumed_at_;
  std::chrono::microseconds least_interval_{0};
  Clock::time_point next_turn_;
  PacerTotals totals_;
  std::chrono::microseconds round_trip_{0};
  double goodput_ = 0.0;
  Clock::time_point last_acknowledgement_;
  LinkController link_;
  AckWindow window_;
};

}  // namespace heliograph::stream
