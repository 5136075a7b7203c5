#include <algorithm>

#include "session/rendering/session_view.hpp"

// A session's frames in lockstep.

namespace heliograph::session {

/// One frame of those that were asked for, whole whatever it takes; between steps the picture is
/// there to be read by those who asked before the next one.
SessionView::Work SessionView::advance_step(bool may_draw) {
  if (!stepped_) settle_unstepped();
  settle_probes();
  if (settle_captures()) return Work::small;
  if (!may_draw && session_->step_due(first_waiting())) {
    return broadcast_.pump() ? Work::small : Work::held_back;
  }
  if (const std::optional<StepFrame> step = session_->begin_step(first_waiting())) {
    adopt(step->state);
    drawn_width_ = state_.width;
    drawn_height_ = state_.height;
    renderer_->set_size(drawn_width_, drawn_height_);
    render_frame(step->seconds);
    stepped_ = true;
    broadcast_.pump();
    session_->end_step(*step, newest_->frame.samples);
    return Work::drawing;
  }
  return broadcast_.pump() ? Work::small : Work::none;
}

/// The place of what is to be read first from what has been drawn.
std::optional<std::uint64_t> SessionView::first_waiting() const {
  std::optional<std::uint64_t> first;
  const auto also = [&](const std::optional<std::uint64_t>& place) {
    if (place) first = first ? std::min(*first, *place) : *place;
  };
  for (const PendingCapture& capture : captures_) also(capture.request.place);
  for (const PendingProbe& pending : probes_) also(pending.probe.place);
  return first;
}

/// Nothing was drawn in lockstep before their place, and nothing will be unasked.
void SessionView::settle_unstepped() {
  const protocol::Error why =
      protocol::error::not_ready("no frame was rendered since lockstep was entered");
  std::erase_if(captures_, [&](const PendingCapture& capture) {
    if (session_->step_due(capture.request.place)) return false;
    capture.request.done(why);
    return true;
  });
  std::erase_if(probes_, [&](const PendingProbe& pending) {
    if (session_->step_due(pending.probe.place)) return false;
    pending.probe.fail(why);
    return true;
  });
}

}  // namespace heliograph::session
