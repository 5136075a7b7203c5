// How a view takes over the state of its session.

#include <utility>

#include "scene/animation/pose.hpp"
#include "scene/animation/tracks.hpp"
#include "scene/camera/camera.hpp"
#include "session/devices/device_migration.hpp"
#include "session/event_log.hpp"
#include "session/rendering/session_view.hpp"

namespace heliograph::session {

using std::chrono::milliseconds;

namespace {

/// Frames keep their buffers for so long after one was read: another one often follows, and the
/// change takes as long as a frame.
constexpr std::chrono::seconds keep_buffers_after{10};

}  // namespace

void SessionView::adopt_state() {
  if (session_->version() != state_.version) adopt(session_->render_state());
}

void SessionView::adopt(RenderState next) {
  const RenderState before = std::exchange(state_, std::move(next));
  DeviceMigration& migration = services_.migration;
  if (!migration.is_done(state_.resources) || !migration.is_done(state_.environment)) {
    // It was loaded just before the device was lost, or for another device.
    session_->migrate(migration);
    state_ = session_->render_state();
  }
  if (state_.resources != shown_scene_) {
    renderer_->set_scene(state_.resources);
    shown_scene_ = state_.resources;
    shown_parts_.reset();
  }
  adopt_edits(before);
  if (state_.reset_count != before.reset_count) {
    renderer_->reset();
    discontinuous_ = true;
  }
  const bool same_scene = state_.resources == before.resources;
  const bool resized = state_.width != before.width || state_.height != before.height;
  if (resized || !same_scene) full_frame_time_ = {};
  const bool jumped = state_.discontinuities != before.discontinuities;
  if (jumped) renderer_->invalidate_history();
  discontinuous_ |= resized || !same_scene || jumped;
  if (same_scene && !scene::same_view(state_.camera, before.camera)) {
    camera_moved_at_ = Clock::now();
  }
  if (!same_scene || state_.animation != before.animation) prepared_moment_.reset();
  adopt_moment();
  apply(state_.settings);
}

/// What the session changed in the scene, but for the parts that clips change, too; a scene that is
/// new to the renderer has no changes yet.
void SessionView::adopt_edits(const RenderState& before) {
  const bool same_scene = state_.resources == before.resources;
  if (state_.section != (same_scene ? before.section : nullptr)) {
    renderer_->set_section(state_.section ? *state_.section : render::Section());
    discontinuous_ = true;
  }
  if (state_.selected != (same_scene ? before.selected : nullptr)) {
    renderer_->set_selected(state_.selected ? std::span(*state_.selected)
                                            : std::span<const std::uint32_t>());
  }
  if (state_.environment != (same_scene ? before.environment : nullptr)) {
    renderer_->set_environment(state_.environment);
    discontinuous_ = true;
  }
}

/// What the clip shows at this time: edited and animated parts, the pose, and the camera where the
/// clip moves it.
void SessionView::adopt_moment() {
  const double seconds = prepared_moment_.value_or(state_.animation.at(state_.now()));
  shown_moment_ = seconds;
  const scene::Clip* const clip =
      state_.scene ? scene::find_clip(*state_.scene, state_.animation.clip) : nullptr;
  discontinuous_ |= shown_parts_.show(*renderer_, {.scene = state_.scene,
                                                   .edited = state_.parts,
                                                   .members = state_.edited_members,
                                                   .clip = clip,
                                                   .seconds = seconds});
  if (const auto posed = renderer_->set_pose(state_.animation.clip, seconds); !posed) {
    log_error({.session = session_->name()}, posed.error().message);
  }
  renderer_->set_camera(state_.camera_follows && clip
                            ? scene::camera_at(*state_.scene, state_.camera, clip, seconds)
                            : state_.camera);
}

bool SessionView::clip_switches_nodes() const {
  const scene::Clip* const clip =
      state_.scene ? scene::find_clip(*state_.scene, state_.animation.clip) : nullptr;
  return clip && scene::switches_nodes(*clip);
}

bool SessionView::next_frame_moves() const {
  return next_view_state(view_inputs()) == ViewState::moving;
}

bool SessionView::plays() const {
  return state_.animation.playing && watched() && !session_->timeline().in_lockstep();
}

void SessionView::adopt_draw_scale() {
  set_draw_scale(next_draw_scale());
}

float SessionView::next_draw_scale() const {
  return draw_scale({.now = Clock::now(),
                     .camera_moved_at = camera_moved_at_,
                     .animation_playing = state_.animation.playing,
                     .full = {state_.width, state_.height},
                     .full_frame_time = full_frame_time_,
                     .frame_time = milliseconds(state_.settings.motion.frame_time),
                     .moving_sessions = moving_sessions_ + (moves() ? 0 : 1),
                     .least_scale = state_.settings.motion.scale,
                     .scale = draw_scale_,
                     .capture_pending = readers_.has_captures()});
}

/// What will be read after a step is not known before it.
void SessionView::keep_buffers(bool lockstep) {
  if (readers_.read_buffers()) buffers_read_at_ = Clock::now();
  renderer_->keep_buffers(lockstep || Clock::now() < buffers_read_at_ + keep_buffers_after);
}

/// The path traced reference is not reconstructed: where it is shown alone, frames are smaller.
void SessionView::set_draw_scale(float scale) {
  const bool reference = state_.settings.reference.use == protocol::ReferenceUse::always;
  const float of_frame = reference ? scale : 1.0f;
  draw_scale_ = scale;
  renderer_->set_size(render::drawn_side(state_.width, of_frame),
                      render::drawn_side(state_.height, of_frame));
  renderer_->set_draw_scale(scale);
}

}  // namespace heliograph::session
