// How a view begins its frames and finishes them.

#include <algorithm>
#include <utility>

#include "render/api/device_lost.hpp"
#include "session/rendering/session_view.hpp"

namespace heliograph::session {

using std::chrono::duration_cast;
using std::chrono::microseconds;

namespace {

/// Histories are measured in seconds. After a pause the time since the last frame means nothing.
constexpr float max_frame_seconds = 1.0f;
/// The device has the next frame before it has room for it, and that is drawn with input as new as
/// can be.
constexpr std::chrono::microseconds time_to_begin{800};

std::uint32_t microseconds_of(Clock::duration duration) {
  return static_cast<std::uint32_t>(duration_cast<microseconds>(duration).count());
}

bool differs_by_camera_alone(const RenderState& before, const RenderState& after) {
  return after.resources == before.resources && after.scene == before.scene &&
         after.parts == before.parts && after.selected == before.selected &&
         after.section == before.section && after.environment == before.environment &&
         after.discontinuities == before.discontinuities &&
         after.camera_follows == before.camera_follows && !before.animation.playing &&
         after.animation == before.animation && after.settings == before.settings &&
         after.width == before.width && after.height == before.height &&
         after.reset_count == before.reset_count && !after.lockstep &&
         after.reference_started == before.reference_started;
}

}  // namespace

void SessionView::begin_next_frame() {
  const std::chrono::duration<float> since = Clock::now() - frame_began_at_;
  newest_stepped_ = false;
  begin_frame(std::min(since.count(), max_frame_seconds));
  if (in_flight() && !renderer_->in_flight()) finish_frame();
}

bool SessionView::can_begin_following() {
  return begun_.size() == 1 && begun_.front().view_state == ViewState::moving &&
         renderer_->can_begin_another() && readers_.empty() &&
         !session_->timeline().in_lockstep() && next_draw_scale() == draw_scale_ &&
         session_->viewers().can_accept_two_frames(device_time_) &&
         wanted_jpeg(ViewState::moving).has_value() == begun_.front().as_jpeg &&
         !(session_->viewers().wants_depth() && depth_pays());
}

void SessionView::begin_following_frame(Clock::time_point device_free) {
  const auto before = duration_cast<Clock::duration>(device_time_ * renderer_->part_before_next());
  const Clock::time_point expected =
      began_on_device(begun_.front(), device_free) + before - time_to_begin;
  renderer_->wait_for(expected - Clock::now());
  readers_.collect();
  if (!can_begin_following()) return;
  RenderState next = session_->render_state();
  if (!differs_by_camera_alone(state_, next)) return;
  needed_at_ = Clock::now();
  session_->viewers().announce_due_frames();
  adopt(std::move(next));
  if (renderer_->can_begin_another() && frame_due()) begin_next_frame();
}

/// `seconds`: that have passed since the last frame.
void SessionView::begin_frame(double seconds) {
  const Clock::time_point start = Clock::now();
  session_->mark_used();
  renderer_->set_frame_seconds(static_cast<float>(seconds));
  const Clock::time_point before = std::exchange(frame_began_at_, start);
  // A viewer that moves the camera does not wait for a frame of the view that it leaves.
  const ViewState view_state = next_view_state(view_inputs());
  const Interruption by = interruption(view_inputs());
  const std::optional<render::JpegRequest> jpeg = wanted_jpeg(view_state);
  renderer_->request_jpeg(jpeg);
  const bool began = renderer_->begin([&] {
    if (by == Interruption::none) return false;
    const bool changed = session_->version() != state_.version;
    return changed &&
           (by == Interruption::any_change || session_->camera().moves() != state_.camera_moves);
  });
  if (began) {
    begun_.push_back({.view_state = view_state,
                      .start = start,
                      .follows = in_flight(),
                      .as_jpeg = jpeg.has_value(),
                      .version = state_.version,
                      .rev = state_.rev,
                      .width = state_.width,
                      .height = state_.height,
                      .inputs = state_.inputs});
  } else {
    frame_began_at_ = before;
  }
}

/// What a step shows may be read after the next one has changed the frame.
std::optional<render::JpegRequest> SessionView::wanted_jpeg(ViewState state) {
  if (!engine_.encodes_jpeg() || session_->timeline().in_lockstep()) return std::nullopt;
  const auto common = session_->viewers().common_jpeg(draw_policy(state).purpose);
  if (!common) return std::nullopt;
  return render::JpegRequest{.quality = common->quality, .percent = common->scale};
}

/// Not before the device was done with the frame before it.
Clock::time_point SessionView::began_on_device(const BegunFrame& begun,
                                               Clock::time_point device_free) const {
  return std::max(begun.start, begun.follows ? frame_ended_at_ : device_free);
}

bool SessionView::frame_is_done() const {
  try {
    return renderer_->wait_for(std::chrono::nanoseconds(0));
  } catch (const render::DeviceLost&) {
    return true;
  }
}

void SessionView::finish_frame(Clock::time_point device_free) {
  const BegunFrame begun = std::move(begun_.front());
  begun_.pop_front();
  render::Frame frame = renderer_->finish();
  if (frame.new_buffers) publish_buffers();
  const Clock::time_point end = Clock::now();
  const Clock::duration taken = end - began_on_device(begun, device_free);
  frame_ended_at_ = end;
  measure_frame(begun.view_state, taken);
  device_time_ = taken;
  services_.measurements.rendered(std::chrono::duration<double>(taken).count(), pass_timings(frame),
                                  frame.radiance_cache);
  newest_ = describe(std::move(frame), begun, end);
  first_frame_due_ = false;
  newest_version_ = begun.version;
  session_->reference().report_frame(newest_version_, newest_->frame.samples,
                                     newest_->frame.converged);
  const bool moves_on = in_flight();
  const ViewState shown_state = moves_on ? begun.view_state : next_view_state(view_inputs());
  broadcast_.rendered(newest_, draw_policy(shown_state).purpose);
  if (moves_on) broadcast_.pump();
}

std::shared_ptr<RenderedFrame> SessionView::describe(render::Frame frame, const BegunFrame& begun,
                                                     Clock::time_point end) {
  frame_times_.push_back(end);
  while (frame_times_.front() < end - std::chrono::seconds(1)) frame_times_.pop_front();

  auto rendered = std::make_shared<RenderedFrame>();
  protocol::FrameHeader& header = rendered->header;
  if (std::exchange(discontinuous_, false)) ++discontinuities_;
  header.render_id = ++render_count_;
  header.state_rev = begun.rev;
  header.full_width = static_cast<std::uint16_t>(begun.width);
  header.full_height = static_cast<std::uint16_t>(begun.height);
  const auto start = begun.start.time_since_epoch();
  header.render_start_us = static_cast<std::uint64_t>(duration_cast<microseconds>(start).count());
  header.render_us = microseconds_of(end - begun.start);
  header.sample_count = frame.samples;
  rendered->frame = std::move(frame);
  rendered->inputs = begun.inputs;
  rendered->discontinuities = discontinuities_;
  rendered->fps = static_cast<double>(frame_times_.size());
  // The device may write its images again by now.
  rendered->depth_read = session_->viewers().wants_depth() && !in_flight();
  if (rendered->depth_read && depth_pays()) rendered->depth = renderer_->depth();
  return rendered;
}

}  // namespace heliograph::session
