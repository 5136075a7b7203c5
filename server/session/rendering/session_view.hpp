#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "render/api/renderer.hpp"
#include "session/state/session.hpp"
#include "session/viewers/broadcast.hpp"

namespace heliograph::session {

/// What all views of one device share.
struct ViewServices {
  WakeEvent& wakeup;              // of the render thread
  Clock::duration release_after;  // nobody has watched for so long: histories are let go
  Worker& encoder;                // pictures for the stream
  stream::JpegEncoder& jpeg;      // used by `encoder` only
  Worker& capture_writer;         // files, which take longer
  Measurements& measurements;
};

/// One session as the render thread sees it: takes over the session's state, draws while somebody
/// wants frames, has them encoded, answers captures. Its renderer, with all images and histories,
/// is made when the first picture is wanted and let go when nobody has watched for a while. Used by
/// the render thread only, apart from construction and `prepare`.
class SessionView {
 public:
  SessionView(render::Engine& engine, SessionOptions options, PixelShare pixels,
              ViewServices services, std::shared_ptr<WakeEvent> wakeup);
  ~SessionView();

  /// Makes the renderer before it is drawn with; the first picture then comes unasked.
  /// @throws render::DeviceLost
  void prepare();

  const std::shared_ptr<Session>& session() const { return session_; }
  bool has_rendered() const { return newest_ != nullptr; }

  /// Whether there may be something to do.
  bool awake() const;
  /// What came of `advance`: nothing to do, something small, a frame, or only a frame that had to
  /// be left undone.
  enum class Work { none, small, drawing, held_back };
  /// Does what is most pressing: at most one frame, and none unless it `may_draw`.
  Work advance(bool may_draw);
  /// When there may be something to do without anybody's asking.
  std::optional<Clock::time_point> next_due() const;
  /// Lets go of the renderer with all its images and histories.
  void release_renderer();
  /// After an exception out of `advance`: fails what waits for pictures and rests for a while.
  void recover();
  /// Drops all captures unanswered.
  void abandon_captures();
  /// Answers all captures that the session has ended.
  void refuse_captures();

 private:
  struct PendingCapture {
    CaptureRequest request;
    Clock::time_point requested;
    Clock::time_point deadline;
  };
  struct PendingProbe {
    Probe probe;
    Clock::time_point requested;
  };

  bool needed() const;
  bool watched() const;
  void make_renderer();
  void apply(const protocol::Settings& settings);
  void tell_buffers();
  void adopt_state();
  void adopt(RenderState next);
  void adopt_edits(const RenderState& before);
  void adopt_pose();
  void adopt_size();
  bool moving() const;
  bool resting() const;
  bool draws_whole() const;
  void collect_captures();
  void drop_unwanted_captures();
  bool settle_captures();
  void settle_probes();
  bool shows_state_since(Clock::time_point moment) const;
  bool capture_ready(const PendingCapture& capture) const;
  bool write_capture(CaptureRequest& request);
  Work advance_step(bool may_draw);
  void settle_unstepped();
  std::optional<std::uint64_t> first_waiting() const;
  bool its_turn_is_later(std::optional<std::uint64_t> place) const;
  bool frame_wanted();
  bool final_due() const;
  void render_frame();
  void render_frame(double seconds);
  std::shared_ptr<RenderedFrame> describe(render::Frame frame, Clock::time_point start,
                                          Clock::time_point end);

  render::Engine& engine_;
  ViewServices services_;
  const std::shared_ptr<WakeEvent> wakeup_;  // of this session
  std::shared_ptr<Session> session_;
  Broadcast broadcast_;
  std::unique_ptr<render::Renderer> renderer_;  // null while nobody needs pictures
  Clock::time_point needed_at_;                 // when somebody last did
  bool draws_unasked_ = false;

  RenderState state_;
  Clock::time_point moved_at_;     // when the camera last did
  std::uint32_t drawn_width_ = 0;  // what the renderer draws now: smaller while moving
  std::uint32_t drawn_height_ = 0;
  Clock::duration whole_frame_{};  // time of the newest frame of full size
  std::shared_ptr<const RenderedFrame> newest_;
  std::uint64_t newest_version_ = 0;
  bool cut_ = true;  // the next picture has nothing in common with the last
  std::uint64_t cuts_ = 0;
  std::uint32_t render_count_ = 0;
  std::deque<Clock::time_point> recent_frames_;
  Clock::time_point last_frame_{};  // when it began
  std::vector<PendingCapture> captures_;
  std::vector<PendingProbe> probes_;
  Clock::time_point resting_until_;
  bool stepped_ = false;  // the newest picture was drawn in lockstep
};

}  // namespace heliograph::session
