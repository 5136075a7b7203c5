#include <utility>

#include "session/rendering/capture_content.hpp"
#include "session/rendering/session_view.hpp"

// What reads a session's pictures: captures and probes.

namespace heliograph::session {

using protocol::Result;

namespace {

constexpr std::chrono::minutes capture_patience{5};

}  // namespace

void SessionView::collect_captures() {
  for (CaptureRequest& request : session_->take_captures()) {
    request.done = [done = std::move(request.done), since = Clock::now(),
                    &measurements = services_.measurements](const Result<Capture>& result) {
      if (result) {
        measurements.captured(std::chrono::duration<double>(Clock::now() - since).count());
      } else {
        measurements.capture_failed();
      }
      done(result);
    };
    captures_.push_back({.request = std::move(request),
                         .requested = Clock::now(),
                         .deadline = Clock::now() + capture_patience});
  }
  for (Probe& probe : session_->take_probes()) {
    probes_.push_back({.probe = std::move(probe), .requested = Clock::now()});
  }
  drop_unwanted_captures();
}

/// Who went has nobody to answer to, and who is in another session learns it.
void SessionView::drop_unwanted_captures() {
  std::erase_if(captures_, [&](const PendingCapture& capture) {
    const std::string& viewer = capture.request.viewer;
    if (viewer.empty() || session_->viewers().has(viewer)) return false;
    capture.request.done(
        protocol::error::not_found("session", "the viewer has left the session of the capture"));
    return true;
  });
}

/// Whether the newest picture shows the state, and as it was no earlier than `moment` where time
/// passes in it.
bool SessionView::shows_state_since(Clock::time_point moment) const {
  if (!newest_) return false;
  if (state_.lockstep) return stepped_;
  if (state_.animation.playing) return newest_version_ == state_.version && last_frame_ >= moment;
  return newest_version_ == state_.version || !renderer_->needs_frame();
}

/// In lockstep, where frames are still to be drawn before it.
bool SessionView::its_turn_is_later(std::optional<std::uint64_t> place) const {
  return state_.lockstep && session_->step_due(place);
}

void SessionView::settle_probes() {
  std::erase_if(probes_, [&](const PendingProbe& pending) {
    if (!shows_state_since(pending.requested) || its_turn_is_later(pending.probe.place))
      return false;
    pending.probe.read(*renderer_, state_);
    return true;
  });
}

bool SessionView::settle_captures() {
  const Clock::time_point now = Clock::now();
  std::vector<PendingCapture> open;
  for (PendingCapture& capture : captures_) {
    if (capture_ready(capture) && write_capture(capture.request)) continue;
    if (now < capture.deadline) {
      open.push_back(std::move(capture));
    } else {
      capture.request.done(
          protocol::error::not_ready("the view did not stay static long enough for the capture"));
    }
  }
  captures_.swap(open);
  return captures_.size() != open.size();
}

bool SessionView::capture_ready(const PendingCapture& capture) const {
  if (state_.lockstep) return stepped_ && !its_turn_is_later(capture.request.place);
  if (!draws_whole() || !shows_state_since(capture.requested)) return false;
  if (newest_->frame.width != state_.width || newest_->frame.height != state_.height) return false;
  if (state_.animation.playing || !renderer_->needs_frame()) return true;
  const std::optional<std::uint32_t>& samples = capture.request.samples;
  return samples && newest_->frame.samples >= *samples;
}

/// False if too many files are being written already.
bool SessionView::write_capture(CaptureRequest& request) {
  if (!services_.capture_writer.has_room()) return false;
  auto content = read_content(*renderer_, request.buffer, request.format);
  if (!content) {
    request.done(content.error());
    return true;
  }
  const std::uint32_t samples = newest_->frame.samples;
  services_.capture_writer.post([request = std::move(request), samples,
                                 content = std::make_shared<CaptureContent>(*std::move(content)),
                                 &wakeup = services_.wakeup] {
    request.done(Capture{.width = content->width,
                         .height = content->height,
                         .samples = samples,
                         .file = encode_content(*content, request.format)});
    wakeup.notify();
  });
  return true;
}

void SessionView::abandon_captures() {
  captures_.clear();
  session_->take_captures();
  probes_.clear();
  session_->take_probes();
  session_->fail_steps(protocol::error::not_ready("the server is shutting down"));
}

void SessionView::refuse_captures() {
  collect_captures();
  for (PendingCapture& capture : captures_) {
    capture.request.done(protocol::error::not_found("session", "the session has ended"));
  }
  captures_.clear();
  const protocol::Error ended = protocol::error::not_found("session", "the session has ended");
  for (const PendingProbe& pending : probes_) pending.probe.fail(ended);
  probes_.clear();
  session_->fail_steps(ended);
}

}  // namespace heliograph::session
