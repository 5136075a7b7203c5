#include "session/rendering/view_state.hpp"

#include <algorithm>

namespace heliograph::session {
namespace {

using std::chrono::milliseconds;

/// Motion stutters where full frames take longer.
constexpr milliseconds slow_frame{66};
/// Images of at most so many pixels are never reduced.
constexpr std::uint32_t min_reducible_pixels = 640 * 360;

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

DrawSize draw_size(const ResolutionInputs& in) {
  const bool moves = in.animation_playing || in.now < in.camera_moved_at + final_delay;
  const bool reduced = moves && !in.capture_pending && in.full_frame_time > slow_frame &&
                       in.full.width * in.full.height > min_reducible_pixels;
  if (!reduced) return in.full;
  const auto scaled = [&](std::uint32_t side) {
    const float pixels = static_cast<float>(side) * in.motion_scale;
    return std::max(1u, static_cast<std::uint32_t>(pixels + 0.5f));
  };
  return {scaled(in.full.width), scaled(in.full.height)};
}

}  // namespace heliograph::session
