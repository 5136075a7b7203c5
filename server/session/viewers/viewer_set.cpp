#include "session/viewers/viewer_set.hpp"

#include <algorithm>
#include <utility>

#include "protocol/json/jsonrpc.hpp"

namespace heliograph::session {

using protocol::Result;
using std::chrono::duration_cast;
using std::chrono::microseconds;

namespace {

stream::OutgoingFrame make_outgoing(const stream::ViewerPacer::Taken& taken,
                                    const std::string& viewer, bool discontinuous, bool depth) {
  protocol::FrameHeader header = taken.frame->header;
  header.frame_seq = taken.frame_seq;
  if (taken.first_after_drop) header.flags |= protocol::frame_flag::first_after_drop;
  if (discontinuous) header.flags |= protocol::frame_flag::discontinuity;
  for (const stream::InputEcho& input : taken.frame->inputs) {
    if (input.viewer == viewer) header.input_seq_echo = input.seq;
  }
  const auto queued = duration_cast<microseconds>(Clock::now() - taken.frame->encoded_at);
  header.queue_us = static_cast<std::uint32_t>(queued.count());
  const std::vector<std::uint8_t>* const surfaces = depth ? taken.frame->depth.get() : nullptr;
  if (surfaces) {
    header.flags |= protocol::frame_flag::depth;
    header.header_bytes =
        static_cast<std::uint16_t>(protocol::frame_header_bytes + surfaces->size());
  }
  const auto fixed = protocol::encode_frame_header(header);
  std::vector<std::uint8_t> bytes(fixed.begin(), fixed.end());
  if (surfaces) bytes.insert(bytes.end(), surfaces->begin(), surfaces->end());
  return {.header = std::move(bytes), .frame = taken.frame};
}

/// What the viewer asked for: its link may be given less.
template <class Viewer>
stream::EncodingVariant asked_by(const Viewer& viewer) {
  return {.codec = viewer.stream.codec, .quality = viewer.stream.quality};
}

/// Adds the measurements of one viewer's stream.
template <class Viewer>
void complete(protocol::StatsFrame& stats, const Viewer& viewer) {
  stats.bytes = viewer.last_bytes;
  stats.encode_ms = viewer.last_encode_us / 1000.0;
  stats.codec = viewer.moving.codec;
  stats.quality = static_cast<std::uint32_t>(viewer.moving.quality);
  stats.scale = viewer.moving.scale / 100.0;
  stats.round_trip_ms = static_cast<double>(viewer.pacer.round_trip().count()) / 1000.0;
  stats.goodput = viewer.pacer.goodput();
}

}  // namespace

ViewerSet::ViewerSet(std::size_t max_viewers, WakeEvent& on_capacity)
    : max_viewers_(max_viewers), on_capacity_(on_capacity) {}

void ViewerSet::start(const std::string& viewer, protocol::StreamCodec codec) {
  const std::lock_guard lock(mutex_);
  const Result<Viewer*> found = find(viewer);
  if (!found) return;
  (*found)->stream.decodes_video = codec != protocol::StreamCodec::jpeg;
  (*found)->stream.codec = codec;
  if (std::exchange((*found)->started, true)) return;
  offer_latest(**found);
  on_capacity_.notify();
}

Result<ViewerStream> ViewerSet::configure(const std::string& viewer,
                                          const protocol::StreamConfigure& change) {
  const std::lock_guard lock(mutex_);
  const Result<Viewer*> found = find(viewer);
  if (!found) return found.error();
  Viewer& target = **found;
  if (change.codec && *change.codec != protocol::StreamCodec::jpeg &&
      !target.stream.decodes_video) {
    return protocol::error::invalid("codec", "is not one of the codecs of hello", "jpeg");
  }
  if (change.codec) target.stream.codec = *change.codec;
  if (change.still && target.stream.still != *change.still) {
    target.stream.still = *change.still;
    target.offered = 0;
    if (target.pacer.frame_pending()) target.pacer.drop_pending();
  }
  if (change.depth) target.stream.depth = *change.depth;
  if (change.quality) target.stream.quality = static_cast<int>(*change.quality);
  if (change.max_fps) {
    target.stream.max_fps = *change.max_fps;
    target.pacer.set_max_rate(target.stream.max_fps);
  }
  if (change.paused) {
    const bool resumes = target.stream.paused && !*change.paused;
    target.stream.paused = *change.paused;
    target.pacer.set_paused(target.stream.paused, Clock::now());
    if (resumes) target.offered = 0;
    if (resumes && target.started) offer_latest(target);
  }
  on_capacity_.notify();
  return target.stream;
}

Result<void> ViewerSet::acknowledge(const std::string& viewer, const protocol::StreamAck& ack) {
  const std::lock_guard lock(mutex_);
  const Result<Viewer*> found = find(viewer);
  if (!found) return found.error();
  Viewer& target = **found;
  // Late and repeated acknowledgements are normal and say nothing new.
  target.pacer.acknowledge(ack.frame_seq, microseconds(ack.present_us), Clock::now());
  if (target.pacer.frame_pending()) announce(target);
  on_capacity_.notify();
  return {};
}

Result<void> ViewerSet::subscribe(const std::string& viewer, std::chrono::milliseconds interval) {
  const std::lock_guard lock(mutex_);
  const Result<Viewer*> found = find(viewer);
  if (!found) return found.error();
  (*found)->stats_interval = interval;
  (*found)->next_stats = {};
  return {};
}

std::optional<Clock::time_point> ViewerSet::unacknowledged_since(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(viewer);
  return found == viewers_.end() ? std::nullopt
                                 : found->second.pacer.unacknowledged_since(Clock::now());
}

std::optional<stream::OutgoingFrame> ViewerSet::take(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  const Result<Viewer*> found = find(viewer);
  if (!found) return std::nullopt;
  const auto taken = (*found)->pacer.take(Clock::now());
  if (!taken) {
    // A frame that only its rate limit holds back needs the render thread's timer.
    if ((*found)->pacer.frame_pending()) on_capacity_.notify();
    return std::nullopt;
  }
  on_capacity_.notify();
  // The discontinuity may have been in a frame that the viewer did not get.
  const std::uint64_t discontinuities = taken->frame->cuts;
  const bool jumped = std::exchange((*found)->discontinuities, discontinuities) != discontinuities;
  const bool discontinuous = std::exchange((*found)->discontinuous, false) || jumped;
  return make_outgoing(*taken, viewer, discontinuous, (*found)->stream.depth);
}

bool ViewerSet::empty() const {
  const std::lock_guard lock(mutex_);
  return viewers_.empty();
}

bool ViewerSet::has(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  return viewers_.contains(viewer);
}

bool ViewerSet::can_accept_frame() const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  return std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
    return entry.second.started && entry.second.pacer.has_room(now);
  });
}

bool ViewerSet::can_accept_two_frames(Clock::duration apart) const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  return std::ranges::any_of(viewers_, [&](const auto& entry) {
    return entry.second.started && entry.second.pacer.has_room_for_two(now, apart);
  });
}

bool ViewerSet::wants_depth() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(viewers_.begin(), viewers_.end(), [](const auto& entry) {
    return entry.second.started && !entry.second.stream.paused && entry.second.stream.depth;
  });
}

bool ViewerSet::has_active_viewer() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(viewers_.begin(), viewers_.end(), [](const auto& entry) {
    return entry.second.started && !entry.second.stream.paused;
  });
}

std::optional<Clock::time_point> ViewerSet::next_send() const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  std::optional<Clock::time_point> next;
  for (const auto& [id, viewer] : viewers_) {
    const Clock::time_point next_frame = viewer.pacer.next_send();
    if (!viewer.started || viewer.stream.paused || next_frame <= now) continue;
    next = next ? std::min(*next, next_frame) : next_frame;
  }
  return next;
}

void ViewerSet::announce_due_frames() {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  for (const auto& [id, viewer] : viewers_) {
    if (viewer.pacer.sendable(now)) announce(viewer);
  }
}

void ViewerSet::discard_latest() {
  const std::lock_guard lock(mutex_);
  latest_.clear();
}

bool ViewerSet::needs_frame(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  return std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
    return viewer_needs_frame(entry.second, number, now);
  });
}

std::optional<stream::EncodingVariant> ViewerSet::common_jpeg(FramePurpose purpose) {
  if (purpose == FramePurpose::final) return std::nullopt;
  const std::lock_guard lock(mutex_);
  std::optional<stream::EncodingVariant> common;
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.started || viewer.stream.paused) continue;
    const stream::EncodingVariant variant = requested_variant(viewer, purpose);
    if (variant.codec != protocol::StreamCodec::jpeg || variant != common.value_or(variant)) {
      return std::nullopt;
    }
    common = variant;
  }
  return common;
}

EncodingPlan ViewerSet::plan(std::uint64_t number, FramePurpose purpose, std::uint64_t pixels,
                             const std::optional<stream::EncodingVariant>& made) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  pixels_ = pixels;
  EncodingPlan plan;
  std::vector<Viewer*> active;
  std::vector<stream::RequestedVariant> requests;
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.started || viewer.stream.paused) continue;
    const bool ready = viewer_needs_frame(viewer, number, now);
    if (ready) viewer.planned = number;
    if (purpose == FramePurpose::final) {
      plan.still_quality = std::max(plan.still_quality, viewer.stream.quality);
      const auto known = std::find(plan.stills.begin(), plan.stills.end(), viewer.stream.still);
      if (ready && known == plan.stills.end()) plan.stills.push_back(viewer.stream.still);
      continue;
    }
    active.push_back(&viewer);
    const stream::EncodingVariant variant = requested_variant(viewer, purpose);
    requests.push_back({.variant = made && takes(viewer, purpose, *made) ? *made : variant,
                        .ready = ready,
                        .decoder = viewer.pacer.decoder(),
                        .budget = viewer.pacer.link().budget()});
  }
  stream::VariantPlanner::Plan chosen = planner_.plan(requests, now);
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i]->variant = chosen.assigned[i];
    if (purpose == FramePurpose::interactive) active[i]->moving = chosen.assigned[i];
  }
  plan.requests = std::move(chosen.requests);
  return plan;
}

void ViewerSet::publish(std::uint64_t number, FramePurpose purpose,
                        std::vector<stream::SharedFrame> frames) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.started || viewer.stream.paused || viewer.offered >= number) continue;
    const bool planned = viewer.planned == number;
    const stream::SharedFrame frame = find_encoding(viewer, purpose, frames);
    if (frame) {
      offer(viewer, frame);
    } else if (planned || !viewer.pacer.has_room(now)) {
      viewer.pacer.skip();
    }
    if (frame || planned) viewer.offered = number;
  }
  for (const stream::SharedFrame& frame : frames) planner_.published(*frame, now);
  if (number != latest_number_) latest_.clear();
  latest_.insert(latest_.end(), frames.begin(), frames.end());
  latest_number_ = number;
  latest_purpose_ = purpose;
}

void ViewerSet::publish_stats(protocol::StatsFrame stats) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const bool finished = stats.state == protocol::StreamPhase::idle;
  for (auto& [id, viewer] : viewers_) {
    const bool subscribed = viewer.stats_interval.count() > 0 && viewer.last_bytes > 0;
    if (!subscribed || (now < viewer.next_stats && !finished)) continue;
    viewer.next_stats = now + viewer.stats_interval;
    complete(stats, viewer);
    const auto link = viewer.link.lock();
    if (link)
      link->send(protocol::make_notification<protocol::notifications::stats_frame>(stats),
                 "stats.frame");
  }
}

ViewerTotals ViewerSet::totals() const {
  const std::lock_guard lock(mutex_);
  ViewerTotals totals{.viewers = viewers_.size(), .sent = departed_};
  std::int64_t measured = 0;
  for (const auto& [id, viewer] : viewers_) {
    totals.sent += viewer.pacer.totals();
    totals.waiting += viewer.pacer.frame_pending() ? 1 : 0;
    totals.in_flight += viewer.pacer.in_flight();
    totals.goodput += viewer.pacer.goodput();
    if (viewer.pacer.goodput() == 0.0) continue;
    totals.mean_round_trip += viewer.pacer.round_trip();
    ++measured;
  }
  if (measured > 0) totals.mean_round_trip /= measured;
  return totals;
}

Result<ViewerSet::Viewer*> ViewerSet::find(const std::string& viewer) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) {
    return protocol::error::not_ready("requires a WebSocket connection");
  }
  return &found->second;
}

void ViewerSet::offer_latest(Viewer& viewer) {
  if (latest_.empty() || viewer.stream.paused) return;
  viewer.variant = requested_variant(viewer, latest_purpose_);
  const stream::SharedFrame frame = find_encoding(viewer, latest_purpose_, latest_);
  // Otherwise the newest frame is encoded once more, for this viewer.
  if (!frame) return;
  offer(viewer, frame);
  viewer.offered = latest_number_;
}

void ViewerSet::offer(Viewer& viewer, const stream::SharedFrame& frame) {
  viewer.last_bytes = frame->payload.size() + protocol::frame_header_bytes;
  viewer.last_encode_us = frame->header.encode_us;
  viewer.pacer.offer(frame);
  announce(viewer);
}

bool ViewerSet::viewer_needs_frame(const Viewer& viewer, std::uint64_t number,
                                   Clock::time_point now) const {
  return viewer.started && viewer.offered < number && viewer.pacer.has_room(now);
}

bool ViewerSet::takes(const Viewer& viewer, FramePurpose purpose,
                      const stream::EncodingVariant& made) {
  const stream::EncodingVariant asked = asked_by(viewer);
  const bool whole = purpose == FramePurpose::interactive || made.scale == asked.scale;
  return whole && stream::LinkController::may_choose(asked, made);
}

stream::EncodingVariant ViewerSet::requested_variant(Viewer& viewer, FramePurpose purpose) const {
  const stream::EncodingVariant asked = asked_by(viewer);
  // Frames of a static image are few and each is better than the last: a video gains nothing.
  if (purpose != FramePurpose::interactive) return viewer.pacer.link().choose_refining(asked);
  return viewer.pacer.link().choose(asked, pixels_);
}

stream::SharedFrame ViewerSet::find_encoding(const Viewer& viewer, FramePurpose purpose,
                                             const std::vector<stream::SharedFrame>& frames) {
  const auto find = [&](auto fits) -> stream::SharedFrame {
    const auto found = std::find_if(frames.begin(), frames.end(),
                                    [&](const stream::SharedFrame& frame) { return fits(*frame); });
    return found == frames.end() ? nullptr : *found;
  };
  if (purpose == FramePurpose::final) {
    const bool lossless = viewer.stream.still == protocol::StillFormat::png;
    return find([&](const stream::EncodedFrame& frame) {
      return (frame.header.codec == protocol::FrameCodec::png) == lossless;
    });
  }
  const auto own = find([&](const stream::EncodedFrame& frame) {
    return frame.variant == viewer.variant && viewer.pacer.can_show(frame);
  });
  if (own || viewer.variant.codec == protocol::StreamCodec::jpeg) return own;
  const stream::EncodingVariant jpeg_fallback =
      stream::VariantPlanner::jpeg_fallback(viewer.variant);
  return find([&](const stream::EncodedFrame& frame) { return frame.variant == jpeg_fallback; });
}

void ViewerSet::announce(const Viewer& viewer) {
  if (const auto link = viewer.link.lock()) link->frame_ready();
}

}  // namespace heliograph::session
