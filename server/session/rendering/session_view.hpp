#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>

#include "render/api/renderer.hpp"
#include "session/edits/animated_parts.hpp"
#include "session/rendering/device_turns.hpp"
#include "session/rendering/frame_readers.hpp"
#include "session/rendering/view_state.hpp"
#include "session/session.hpp"
#include "session/viewers/broadcast.hpp"

namespace heliograph::session {

class DeviceMigration;

/// What all views of one device share.
struct ViewServices {
  WakeEvent& wake;                // of the render thread
  Clock::duration release_after;  // without viewers for so long, the renderer is released
  Worker& encoder;                // of streamed frames
  stream::JpegEncoder& jpeg;
  Worker& capture_writer;  // of files, which take longer
  Worker& preparer;        // of what new frames are rendered with
  DeviceMigration& migration;
  Measurements& measurements;
};

/// One session as the render thread sees it: takes over the session's state, renders what ViewState
/// asks for, has frames encoded, answers captures and probes. The renderer, with all images and
/// histories, is made when the first frame is needed and released when it has not been needed for a
/// while. Used by the render thread only, apart from construction and `prepare`.
class SessionView {
 public:
  SessionView(render::Engine& engine, SessionOptions options, PixelShare pixels,
              ViewServices services, std::shared_ptr<WakeEvent> wake);
  ~SessionView();

  /// Makes the renderer before the first frame, which is then rendered without viewers.
  /// @throws render::DeviceLost
  void prepare();

  const std::shared_ptr<Session>& session() const { return session_; }
  bool has_rendered() const { return newest_ != nullptr; }

  /// Whether there may be something to do.
  bool awake() const;
  TurnKind turn_kind() const;
  /// Whether its frames of a moving view take turns with those of other sessions.
  bool moves() const;
  /// Whether the next frame is one of a moving view.
  bool next_frame_moves() const;
  /// Whether viewers watch a clip that plays: the next frame comes when they have taken this one.
  bool plays() const;
  /// How many sessions' do.
  void share_device(std::size_t moving_sessions) { moving_sessions_ = moving_sessions; }
  /// What `advance` did: nothing, something short, a frame, or no frame although one is due.
  enum class Work { none, small, drawing, held_back };
  /// Does what is most urgent: at most one frame, and none unless it `may_draw`. The device may
  /// still work on that frame: then nothing but finish_frame() comes next.
  Work advance(bool may_draw);
  /// Whether the device still works on a frame.
  bool in_flight() const { return !begun_.empty(); }
  /// Whether finish_frame() would not wait; also where it would fail, since the device is lost.
  bool frame_is_done() const;
  /// Whether its next frame may begin before the device is done with the one that it works on.
  bool can_begin_following();
  /// Begins it shortly before the device has room for it, where nothing but the camera has changed:
  /// the device goes on while the earlier frame is read and sent.
  void begin_following_frame(Clock::time_point device_free);
  /// Whether its next frame adds to a reference that was not asked for.
  bool refines_reference() const;
  /// Waits for it and shows it. `device_free`: when the device was done with the frame of another
  /// view, before which it did not work on this one.
  void finish_frame(Clock::time_point device_free = {});
  /// When there may be something to do without any event.
  std::optional<Clock::time_point> next_due() const;
  /// Releases the renderer with all its images and histories.
  void release_renderer();
  /// After an exception out of `advance`: everything pending fails, and rendering pauses.
  void recover();
  /// Drops all captures and probes without an answer.
  void abandon_captures();
  /// All captures, probes and steps fail, since the session has ended.
  void refuse_captures();

 private:
  bool needed() const;
  bool watched() const;
  bool refines() const;
  RenderState state_of_new_renderer();
  void make_renderer(const RenderState& state);
  void apply(const protocol::Settings& settings);
  void publish_buffers();
  void adopt_state();
  void adopt(RenderState next);
  void adopt_edits(const RenderState& before);
  void adopt_moment();
  bool clip_switches_nodes() const;
  void adopt_draw_scale();
  void keep_buffers(bool lockstep);
  void set_draw_scale(float scale);
  void measure_frame(ViewState state, Clock::duration taken);
  bool depth_pays() const;
  bool is_full_size() const;
  bool needs_frame() const;
  ViewInputs view_inputs() const;
  bool frame_due();
  ReadableFrame readable_frame(bool lockstep);
  Work advance_step(bool may_draw);
  bool is_preparing();
  bool begin_making();
  bool begin_preparing();
  bool begin_freeing();
  bool begin_migration();
  bool prepare_beside(std::function<void()> task);
  void begin_next_frame();
  float next_draw_scale() const;
  void begin_frame(double seconds);
  std::optional<render::JpegRequest> wanted_jpeg(ViewState state);
  struct BegunFrame;
  Clock::time_point began_on_device(const BegunFrame& begun, Clock::time_point device_free) const;
  std::shared_ptr<RenderedFrame> describe(render::Frame frame, const BegunFrame& begun,
                                          Clock::time_point end);

  render::Engine& engine_;
  ViewServices services_;
  const std::shared_ptr<WakeEvent> wake_;  // of this session
  std::shared_ptr<Session> session_;
  Broadcast broadcast_;
  FrameReaders readers_;
  /// A frame that the device works on, and what it shows.
  struct BegunFrame {
    ViewState view_state;  // that it is drawn for
    Clock::time_point start;
    bool follows = false;       // it has begun before the device was done with the one before
    bool as_jpeg = false;       // then its pixels are gone once another one has begun
    std::uint64_t version = 0;  // of the session's state, like the next ones
    std::uint32_t rev = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<stream::InputEcho> inputs;
  };
  std::deque<BegunFrame> begun_;                // the older one first
  std::unique_ptr<render::Renderer> renderer_;  // null while no frames are needed
  std::future<void> preparing_;   // of the renderer or the scene, which are not touched meanwhile
  Clock::time_point needed_at_;   // last time that it was needed
  bool first_frame_due_ = false;  // rendered without viewers

  RenderState state_;
  std::shared_ptr<const render::SceneResources> shown_scene_;  // by the renderer
  ShownParts shown_parts_;                                     // likewise
  double shown_moment_ = 0.0;                                  // of the clip, seconds
  std::optional<double> prepared_moment_;  // of the clip, for the next frame; seconds
  Clock::time_point camera_moved_at_;
  float draw_scale_ = 1.0f;            // of the renderer
  Clock::time_point moving_frame_at_;  // the end of the newest moving frame
  std::size_t moving_sessions_ = 1;
  Clock::duration full_frame_time_{};  // that moving frames take at full size; zero: not known
  Clock::duration device_time_{};      // that the newest took
  Clock::time_point frame_ended_at_;   // when the device was done with it
  std::shared_ptr<const RenderedFrame> newest_;
  std::uint64_t newest_version_ = 0;     // of the state that it shows
  bool newest_stepped_ = false;          // it was rendered in lockstep
  Clock::time_point buffers_read_at_{};  // last time that a reader of buffers waited
  bool discontinuous_ = true;            // the next frame does not continue the last one
  std::uint64_t discontinuities_ = 0;
  std::uint32_t render_count_ = 0;
  std::deque<Clock::time_point> frame_times_;  // ends of frames in the last second
  Clock::time_point frame_began_at_{};         // the newest
  Clock::time_point retry_at_;                 // after a failure
};

}  // namespace heliograph::session
