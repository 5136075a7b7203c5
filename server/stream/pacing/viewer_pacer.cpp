#include "stream/pacing/viewer_pacer.hpp"

#include <algorithm>
#include <utility>

namespace heliograph::stream {
namespace {

/// Weight of a new measurement, as in TCP's smoothed round trip time (RFC 6298).
constexpr double newest_frame_weight = 1.0 / 8.0;

}  // namespace

bool ViewerPacer::can_show(const EncodedFrame& frame) const {
  if (!frame.video || (frame.header.flags & protocol::frame_flag::key)) return true;
  // This frame would replace the pending one and depend on it.
  const bool breaks = pending_ && pending_->video;
  return decoder_ && !breaks && frame.video->follows(*decoder_);
}

void ViewerPacer::offer(SharedFrame frame) {
  if (paused_) return;
  if (pending_) {
    ++totals_.dropped;
    dropped_since_taken_ = true;
    if (pending_->video) decoder_.reset();
  }
  if (frame->video) decoder_ = frame->video;
  pending_ = std::move(frame);
  offered_ = ++last_number_;
}

void ViewerPacer::drop_pending() {
  pending_ = nullptr;
  decoder_.reset();
}

void ViewerPacer::skip() {
  if (paused_) return;
  ++last_number_;
  ++totals_.dropped;
  dropped_since_taken_ = true;
}

std::optional<ViewerPacer::Taken> ViewerPacer::take(Clock::time_point now) {
  if (!sendable(now)) return std::nullopt;
  Taken taken{.frame_seq = offered_,
              .first_after_drop = std::exchange(dropped_since_taken_, false),
              .frame = std::exchange(pending_, nullptr)};
  const EncodedFrame& frame = *taken.frame;
  const std::uint64_t bytes = frame.payload.size() + protocol::frame_header_bytes;
  const bool key_of_video = frame.video && (frame.header.flags & protocol::frame_flag::key);
  const bool all_measurable = std::all_of(in_flight_.begin(), in_flight_.end(),
                                          [](const Sent& sent) { return sent.measurable; });
  in_flight_.push_back({.frame_seq = taken.frame_seq,
                        .bytes = bytes,
                        .at = now,
                        .variant = frame.variant,
                        .rendering = std::chrono::microseconds(frame.header.render_us),
                        .ahead = in_flight_.size(),
                        .measurable = frame.moving && !key_of_video && all_measurable});
  // The interval is kept if a frame is slightly late, but does not accumulate over a pause.
  next_send_ = std::max(next_send_ + min_interval_, now + min_interval_ / 2);
  ++totals_.frames;
  totals_.bytes += bytes;
  return taken;
}

bool ViewerPacer::acknowledge(std::uint32_t frame_seq, std::chrono::microseconds held,
                              Clock::time_point now) {
  const auto known = std::find_if(in_flight_.begin(), in_flight_.end(),
                                  [&](const Sent& sent) { return sent.frame_seq == frame_seq; });
  if (known == in_flight_.end()) return false;
  measure(*known, held, now);
  totals_.acknowledged += static_cast<std::uint64_t>(known + 1 - in_flight_.begin());
  in_flight_.erase(in_flight_.begin(), known + 1);
  return true;
}

void ViewerPacer::measure(const Sent& sent, std::chrono::microseconds held, Clock::time_point now) {
  using std::chrono::duration_cast;
  using std::chrono::microseconds;
  const auto total = std::max(duration_cast<microseconds>(now - sent.at), microseconds(1));
  // The client's figure is limited to the possible range.
  const auto sample = total - std::clamp(held, microseconds(0), total);
  totals_.round_trips.add(std::chrono::duration<double>(sample).count());
  // A frame queued behind another one starts its transfer when that has arrived.
  const auto alone = now - std::max(sent.at, last_acknowledgement_);
  last_acknowledgement_ = now;
  const auto taken = std::max(duration_cast<microseconds>(alone), microseconds(1));
  const double rate = static_cast<double>(sent.bytes) * 1e6 / static_cast<double>(taken.count());
  const bool first = goodput_ == 0.0;
  const double weight = first ? 1.0 : newest_frame_weight;
  goodput_ += weight * (rate - goodput_);
  const auto follow = [weight](microseconds& smoothed, microseconds newest) {
    const auto apart = static_cast<double>((newest - smoothed).count());
    smoothed += microseconds(static_cast<std::int64_t>(weight * apart));
  };
  follow(round_trip_, sample);
  follow(in_flight_for_, total);
  if (!sent.measurable) return;
  const auto interval = std::max(sent.rendering, min_interval_);
  window_.arrived({.delay = sample, .interval = interval, .ahead = sent.ahead}, now);
  link_.arrived(
      {.bytes = sent.bytes, .variant = sent.variant, .delay = sample, .interval = interval}, now);
}

void ViewerPacer::set_max_rate(double frames_per_second) {
  min_interval_ = std::chrono::microseconds(static_cast<std::int64_t>(1e6 / frames_per_second));
  next_send_ = {};
}

void ViewerPacer::set_paused(bool paused, Clock::time_point now) {
  if (paused_ && !paused) resumed_at_ = now;
  paused_ = paused;
  if (!paused_) return;
  // A resumed stream starts with a key frame, even if no frame was missed: a viewer whose decoder
  // failed pauses and resumes to get one.
  decoder_.reset();
  pending_ = nullptr;
}

bool ViewerPacer::sendable(Clock::time_point now) const {
  return pending_ && !paused_ && window_open() && now >= next_send_;
}

bool ViewerPacer::has_room(Clock::time_point now) const {
  return !paused_ && !pending_ && window_open() && now >= next_send_;
}

bool ViewerPacer::has_room_for_two(Clock::time_point now, Clock::duration apart) const {
  if (!has_room(now) || min_interval_ > apart) return false;
  const auto stays = [&](const Sent& sent) {
    return goodput_ == 0.0 || sent.at + in_flight_for_ > now + apart;
  };
  const auto staying = std::count_if(in_flight_.begin(), in_flight_.end(), stays);
  return static_cast<std::size_t>(staying) + 1 < window_.size();
}

}  // namespace heliograph::stream
