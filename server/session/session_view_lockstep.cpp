#include "session/session_view.hpp"

// A session's frames in lockstep.

namespace heliograph::session {

/// One frame of those that were asked for, whole whatever it takes; between steps the picture is
/// there to be read.
SessionView::Work SessionView::advance_step(bool may_draw) {
  if (!may_draw && session_->step_due()) return broadcast_.pump() ? Work::small : Work::held_back;
  if (const std::optional<double> dt = session_->begin_step()) {
    adopt_state();
    drawn_width_ = state_.width;
    drawn_height_ = state_.height;
    renderer_->set_size(drawn_width_, drawn_height_);
    render_frame(*dt);
    stepped_ = true;
    broadcast_.pump();
    session_->end_step(newest_->frame.samples);
    return Work::drawing;
  }
  if (broadcast_.pump()) return Work::small;
  if (!stepped_) {
    settle_unstepped();
    return Work::none;
  }
  settle_probes();
  return settle_captures() ? Work::small : Work::none;
}

/// Nothing was drawn in lockstep yet, and nothing will be unasked.
void SessionView::settle_unstepped() {
  const protocol::Error why = protocol::error::not_ready("no frame was stepped yet");
  for (PendingCapture& capture : captures_) capture.request.done(why);
  captures_.clear();
  for (const PendingProbe& pending : probes_) pending.probe.fail(why);
  probes_.clear();
}

}  // namespace heliograph::session
