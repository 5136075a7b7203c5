#include "session/rendering/view_state.hpp"

#include <algorithm>

namespace heliograph::session {
namespace {

/// Images of at most so many pixels are never reduced.
constexpr std::uint32_t min_reducible_pixels = 320 * 180;
/// Fractions of width and height that frames are drawn at.
constexpr float scale_steps[] = {1.0f, 0.8f, 0.67f, 0.5f};
/// The part of a frame's time that does not depend on the size it is drawn at.
constexpr float size_share = 0.1f;
/// A larger scale must be expected to take so much of that time, the present one may take so
/// much: a scene whose times swing about it keeps one scale.
constexpr float step_up = 0.8f;
constexpr float stay = 1.15f;

bool is_moving(const ViewInputs& in) {
  return in.lockstep || in.animation_playing || in.newer_state || in.reduced_size ||
         in.now < in.state_changed_at + refine_delay;
}

}  // namespace

ViewState next_view_state(const ViewInputs& in) {
  if (is_moving(in)) return ViewState::moving;
  if (in.needs_frame) return ViewState::refining;
  if (!in.has_frame || !in.converged || in.final_sent) return ViewState::idle;
  if (in.now < in.state_changed_at + final_delay) return ViewState::refining;
  return ViewState::final;
}

Interruption interruption(const ViewInputs& in) {
  if (next_view_state(in) == ViewState::refining) return Interruption::any_change;
  // The frame after a canceled one is of a moving camera: one of them is always finished.
  const bool moves = in.now < in.camera_moved_at + final_delay;
  const bool rests = !moves && !in.lockstep && !in.animation_playing && !in.reduced_size;
  return rests ? Interruption::camera_move : Interruption::none;
}

std::optional<Clock::time_point> next_view_transition(const ViewInputs& in) {
  if (in.lockstep) return std::nullopt;
  std::optional<Clock::time_point> next;
  const auto consider = [&](Clock::time_point time) {
    if (time > in.now) next = next ? std::min(*next, time) : time;
  };
  if (in.has_frame && in.converged && !in.final_sent && !in.animation_playing) {
    consider(in.state_changed_at + final_delay);
  }
  if (in.reduced_size) consider(in.camera_moved_at + final_delay);
  return next;
}

bool should_draw(ViewState state, const FrameDemand& demand) {
  if (!demand.needs_frame) return false;
  if (demand.requested) return true;
  switch (draw_policy(state).pace) {
    case Pace::none:
      return false;
    case Pace::viewers:
      return demand.viewer_accepts && !demand.encoder_behind;
    case Pace::unlimited:
      return demand.active_viewer;
  }
  return false;
}

float time_share(float scale) {
  return size_share + (1.0f - size_share) * scale * scale;
}

float draw_scale(const ResolutionInputs& in) {
  const bool moves = in.animation_playing || in.now < in.camera_moved_at + final_delay;
  const bool reducible = in.full.width * in.full.height > min_reducible_pixels;
  if (!moves || in.capture_pending || !reducible) return 1.0f;
  if (in.frame_time == Clock::duration::zero()) return in.least_scale;
  const auto fits = [&](float scale) {
    const float margin = scale > in.scale ? step_up : scale == in.scale ? stay : 1.0f;
    const auto turns = static_cast<float>(std::max<std::size_t>(in.moving_sessions, 1));
    return turns * time_share(scale) * static_cast<float>(in.full_frame_time.count()) <=
           margin * static_cast<float>(in.frame_time.count());
  };
  for (const float scale : scale_steps) {
    if (scale <= in.least_scale) break;
    if (fits(scale)) return scale;
  }
  return in.least_scale;
}

}  // namespace heliograph::session
