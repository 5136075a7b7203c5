#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "session/viewers/frame_purpose.hpp"
#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// What is drawn and sent of a session, and when. Pure logic: no threads, no rendering.
///
///            change, playback, lockstep, reduced size
///   any state ----------------------------------------> moving
///   moving ----- static for refine_delay, full size --> refining
///   refining --- converged, static for final_delay ---> final
///   final ------ sent --------------------------------> idle
///   idle ------- needs a frame again -----------------> refining
enum class ViewState {
  moving,    // the image changes or has just changed
  refining,  // the image is static and accumulates samples
  final,     // converged; the final frame has not been sent
  idle,      // nothing to draw or send
};

/// After a change frames are sent as they come for so long.
inline constexpr std::chrono::milliseconds refine_delay{150};
/// How long the image must be static before the final frame is sent, and the camera before dynamic
/// resolution ends.
inline constexpr std::chrono::milliseconds final_delay{300};

/// What the state of a view follows from.
struct ViewInputs {
  Clock::time_point now;
  Clock::time_point camera_moved_at;   // last change of the camera within one scene
  Clock::time_point state_changed_at;  // last change of anything that frames show
  bool newer_state = false;            // the session has changed since its state was taken over
  bool animation_playing = false;
  bool lockstep = false;
  bool reduced_size = false;  // frames are drawn at less than full resolution
  bool needs_frame = false;   // the next frame would differ from the newest one
  bool has_frame = false;
  bool converged = false;   // the newest frame has all its samples
  bool final_sent = false;  // the newest frame was sent as the final one
};

ViewState next_view_state(const ViewInputs& in);

/// What makes a frame that has begun worthless, so that it is canceled where the device can.
enum class Interruption {
  none,
  camera_move,  // the frame of a camera at rest may be long, those of a moving one are short
  any_change    // of what is shown
};

Interruption interruption(const ViewInputs& in);

/// When the state changes next without any event; nothing where it does not. The end of
/// `refine_delay` is left out: what may be drawn then is asked for by an event of its own, an
/// acknowledgement or the end of a viewer's frame interval.
std::optional<Clock::time_point> next_view_transition(const ViewInputs& in);

/// How fast frames are drawn.
enum class Pace {
  none,
  viewers,   // as viewers accept them and the encoder keeps up
  unlimited  // as the device allows, while any viewer is active
};

/// What is drawn in one state of a view.
struct DrawPolicy {
  bool dynamic_resolution;  // it may be drawn at less than full resolution
  Pace pace;
  FramePurpose purpose;  // of the frames that are sent; it decides their quality
};

/// Only a few of the frames of a static image are sent, so that it may converge at full speed.
constexpr DrawPolicy draw_policy(ViewState state) {
  switch (state) {
    case ViewState::moving:
      return {true, Pace::viewers, FramePurpose::interactive};
    case ViewState::refining:
      return {false, Pace::unlimited, FramePurpose::refining};
    case ViewState::final:
    case ViewState::idle:
      break;
  }
  return {false, Pace::none, FramePurpose::final};
}

/// Why a frame may be needed.
struct FrameDemand {
  bool needs_frame = false;     // as in ViewInputs
  bool requested = false;       // by a capture, a probe, a reference, or as the first frame
  bool active_viewer = false;   // a viewer is connected and not paused
  bool viewer_accepts = false;  // by its rate limit and acknowledgement window
  bool encoder_behind = false;  // a frame waits for the encoder already
};

bool should_draw(ViewState state, const FrameDemand& demand);

/// In pixels.
struct DrawSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const DrawSize&) const = default;
};

/// What dynamic resolution depends on.
struct ResolutionInputs {
  Clock::time_point now;
  Clock::time_point camera_moved_at;  // as in ViewInputs
  bool animation_playing = false;
  DrawSize full;                      // the session's size
  Clock::duration full_frame_time{};  // that a moving frame takes at full size; zero: not known
  Clock::duration frame_time{};       // that it should take at most; zero: any is too long
  std::size_t moving_sessions = 1;    // whose frames take turns on the device, this one's too
  float least_scale = 1.0f;           // of width and height
  float scale = 1.0f;                 // of the newest frame
  bool capture_pending = false;       // captures are of full resolution
};

/// The fraction of width and height to draw at: less than 1 while the camera moves or a clip plays
/// and full frames are slow, by themselves or because those of other sessions come in between. Of a
/// few steps, and it changes only where times differ clearly, since every change scales all
/// histories.
float draw_scale(const ResolutionInputs& in);

/// The part of a full frame's time that a frame takes at this scale.
float time_share(float scale);

}  // namespace heliograph::session
