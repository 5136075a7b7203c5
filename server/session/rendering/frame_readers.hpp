#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "session/rendering/rendered_frame.hpp"
#include "session/session.hpp"
#include "session/worker.hpp"

namespace heliograph::session {

/// The newest frame of a session, as captures and probes find it on the render thread.
struct ReadableFrame {
  render::Renderer& renderer;
  const RenderState& state;     // that the renderer has
  const RenderedFrame* newest;  // null: none was rendered
  bool lockstep = false;        // the session is in lockstep, `state` perhaps not yet
  bool shows_state = false;     // the newest frame shows `state`
  bool full_size = false;       // it is not reduced by dynamic resolution
  bool stepped = false;         // it was rendered in lockstep
  Clock::time_point began;      // when its rendering began
};

/// Whether a static view has all samples but those of a path traced reference that was not asked
/// for (`reference.use=automatic`).
bool lacks_reference_alone(const protocol::Settings& settings, const render::Frame& frame);

struct CapturedContent;

/// Captures and probes that wait for a frame of one session. For the render thread.
class FrameReaders {
 public:
  /// `written` is notified when a file has been written. All are used for as long as this exists.
  FrameReaders(Session& session, Worker& capture_writer, Measurements& measurements,
               WakeEvent& written);

  /// Takes those that the session has accepted; those without a caller fail.
  void collect();
  bool empty() const { return captures_.empty() && probes_.empty(); }
  bool has_captures() const { return !captures_.empty(); }
  /// Whether one of them reads buffers that not every frame keeps.
  bool read_buffers() const;
  /// In lockstep: the first ticket of all.
  std::optional<Ticket> first_ticket() const;

  /// Answers the probes that this frame is for.
  void answer_probes(const ReadableFrame& frame);
  /// Has the files written of captures that this frame is for; those past their timeout fail. False
  /// if there was nothing to do.
  bool answer_captures(const ReadableFrame& frame);
  /// In lockstep, before any step: what comes before the first step fails, since no frame will be
  /// rendered for it.
  void fail_before_first_step();
  void fail_all(const protocol::Error& why);
  /// Drops all of them without an answer, those in the session's queue included.
  void drop_all();

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

  void count_when_done(CaptureRequest& request, Clock::time_point requested);
  void fail_captures_of_departed();
  bool is_ready(const PendingCapture& capture, const ReadableFrame& frame) const;
  bool comes_after_steps(const ReadableFrame& frame, std::optional<Ticket> ticket) const;
  /// Where this frame shows them.
  protocol::Result<stream::ImageMarks> marks_of(const ReadableFrame& frame);
  bool write(CaptureRequest& request, const ReadableFrame& frame);
  void post(const std::shared_ptr<CaptureRequest>& request,
            const std::shared_ptr<CapturedContent>& captured);

  Session& session_;
  Worker& capture_writer_;
  Measurements& measurements_;
  WakeEvent& written_;
  std::vector<PendingCapture> captures_;
  std::vector<PendingProbe> probes_;
};

}  // namespace heliograph::session
