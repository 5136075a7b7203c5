#include "session/rendering/frame_readers.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "session/event_log.hpp"
#include "session/inspection/frame_marks.hpp"
#include "session/measurements.hpp"
#include "session/rendering/capture_content.hpp"

namespace heliograph::session {

using protocol::Result;

/// What a capture is written from, beside the render thread.
struct CapturedContent {
  CaptureContent content;
  stream::ImageMarks marks;
  std::uint32_t samples;
};

namespace {

constexpr std::chrono::minutes capture_timeout{5};

/// Whether the frame shows the state, as it was no earlier than `moment` where time passes in it.
bool shows_state_since(const ReadableFrame& frame, Clock::time_point moment) {
  if (!frame.newest || frame.state.first_view) return false;
  if (frame.lockstep) return frame.stepped;
  return frame.shows_state && (!frame.state.animation.playing || frame.began >= moment);
}

void draw_over(CaptureContent& content, const stream::ImageMarks& marks) {
  if (auto* const frame = std::get_if<render::Frame>(&content.values)) {
    stream::draw_marks(frame->rgba, frame->width, frame->height, marks);
  }
}

/// An error where there is no memory for the file: its caller waits for an answer.
Result<Capture> encoded(CapturedContent& captured, const CaptureRequest& request) {
  CaptureContent& content = captured.content;
  try {
    if (request.marks == CaptureMarks::drawn) draw_over(content, captured.marks);
    Capture capture{.width = content.width,
                    .height = content.height,
                    .samples = captured.samples,
                    .file = encode_content(content, request.format),
                    .marks = {}};
    if (request.marks == CaptureMarks::listed) capture.marks = std::move(captured.marks);
    return capture;
  } catch (const std::exception& failure) {
    log_error({}, std::string("a capture could not be encoded: ") + failure.what());
    return protocol::error::internal();
  }
}

/// With an error where there is no memory for a large answer.
void answer(const CaptureRequest& request, CapturedContent& captured) {
  try {
    request.done(encoded(captured, request));
  } catch (const std::exception& failure) {
    log_error({}, std::string("a capture could not be sent: ") + failure.what());
    request.done(protocol::error::internal());
  }
}

}  // namespace

bool lacks_reference_alone(const protocol::Settings& settings, const render::Frame& frame) {
  return settings.reference.use == protocol::ReferenceUse::automatic &&
         frame.samples >= static_cast<std::uint32_t>(settings.accumulation.max_samples);
}

FrameReaders::FrameReaders(Session& session, Worker& capture_writer, Measurements& measurements,
                           WakeEvent& written)
    : session_(session),
      capture_writer_(capture_writer),
      measurements_(measurements),
      written_(written) {}

void FrameReaders::collect() {
  const Clock::time_point now = Clock::now();
  std::vector<CaptureRequest> taken = session_.captures().take_captures();
  std::vector<Probe> probes = session_.captures().take_probes();
  try {
    captures_.reserve(captures_.size() + taken.size());
    probes_.reserve(probes_.size() + probes.size());
    for (CaptureRequest& request : taken) count_when_done(request, now);
  } catch (const std::exception&) {
    // Their callers wait for an answer.
    for (const CaptureRequest& request : taken) request.done(protocol::error::internal());
    for (const Probe& probe : probes) probe.fail(protocol::error::internal());
    throw;
  }
  for (CaptureRequest& request : taken) {
    captures_.push_back(
        {.request = std::move(request), .requested = now, .deadline = now + capture_timeout});
  }
  for (Probe& probe : probes) probes_.push_back({.probe = std::move(probe), .requested = now});
  fail_captures_of_departed();
}

/// Unchanged where there is no memory for that.
void FrameReaders::count_when_done(CaptureRequest& request, Clock::time_point requested) {
  request.done = [done = request.done, requested,
                  &measurements = measurements_](const Result<Capture>& result) {
    if (result) {
      measurements.captured(std::chrono::duration<double>(Clock::now() - requested).count());
    } else {
      measurements.capture_failed();
    }
    done(result);
  };
}

/// A viewer in another session receives the error; one that has disconnected does not.
void FrameReaders::fail_captures_of_departed() {
  std::erase_if(captures_, [&](const PendingCapture& capture) {
    const CaptureRequest& request = capture.request;
    const bool departed = !request.viewer.empty() && !session_.viewers().has(request.viewer);
    const bool abandoned = request.answer && request.answer->abandoned();
    if (!departed && !abandoned) return false;
    request.done(protocol::error::not_found(
        "session", departed ? "the viewer has left the session of the capture"
                            : "the caller has closed its connection"));
    return true;
  });
}

bool FrameReaders::read_buffers() const {
  return std::ranges::any_of(probes_, [](const auto& it) { return it.probe.reads_buffers; }) ||
         std::ranges::any_of(captures_, [](const auto& it) {
           return reads_other_buffers(it.request.buffer, it.request.format);
         });
}

std::optional<Ticket> FrameReaders::first_ticket() const {
  std::optional<Ticket> first;
  for (const PendingCapture& capture : captures_) first = earliest(first, capture.request.ticket);
  for (const PendingProbe& pending : probes_) first = earliest(first, pending.probe.ticket);
  return first;
}

/// In lockstep, where frames are still to be rendered before it.
bool FrameReaders::comes_after_steps(const ReadableFrame& frame,
                                     std::optional<Ticket> ticket) const {
  return frame.lockstep && session_.timeline().step_due(ticket);
}

void FrameReaders::answer_probes(const ReadableFrame& frame) {
  std::erase_if(probes_, [&](const PendingProbe& pending) {
    if (!shows_state_since(frame, pending.requested)) return false;
    if (pending.probe.reads_buffers && !frame.renderer.has_buffers()) return false;
    if (comes_after_steps(frame, pending.probe.ticket)) return false;
    pending.probe.read(frame.renderer, frame.state);
    return true;
  });
}

bool FrameReaders::answer_captures(const ReadableFrame& frame) {
  const Clock::time_point now = Clock::now();
  // In place: where memory runs out, those that are left are answered by fail_all().
  const auto answered = std::erase_if(captures_, [&](PendingCapture& capture) {
    if (is_ready(capture, frame) && write(capture.request, frame)) return true;
    if (now < capture.deadline) return false;
    capture.request.done(
        protocol::error::not_ready("the view did not stay static long enough for the capture"));
    return true;
  });
  return answered > 0;
}

bool FrameReaders::is_ready(const PendingCapture& capture, const ReadableFrame& frame) const {
  const RenderState& state = frame.state;
  const bool reads_buffers = reads_other_buffers(capture.request.buffer, capture.request.format);
  if (reads_buffers && !frame.renderer.has_buffers()) return false;
  if (frame.lockstep) return frame.stepped && !comes_after_steps(frame, capture.request.ticket);
  if (!frame.full_size || !shows_state_since(frame, capture.requested)) return false;
  const render::Frame& newest = frame.newest->frame;
  if (newest.width != state.width || newest.height != state.height) return false;
  if (state.animation.playing || !frame.renderer.needs_frame()) return true;
  const std::optional<std::uint32_t>& samples = capture.request.samples;
  if (lacks_reference_alone(state.settings, newest)) return true;
  return samples ? newest.samples >= *samples : is_complete_at_once(capture.request.buffer);
}

Result<stream::ImageMarks> FrameReaders::marks_of(const ReadableFrame& frame) {
  if (!frame.state.scene) return stream::ImageMarks();
  const scene::Scene& scene = *frame.state.scene;
  const FrameView view(frame.state, frame.state.lockstep.value_or(frame.began));
  return frame_marks(frame.renderer, view, session_.measurements().list_in(scene, view.pose()),
                     session_.annotations().list_in(scene, view.pose()));
}

/// False if too many files are being written already.
bool FrameReaders::write(CaptureRequest& request, const ReadableFrame& frame) {
  if (!capture_writer_.has_room()) return false;
  auto content = read_content(frame.renderer, request.buffer, request.format);
  if (!content) {
    request.done(content.error());
    return true;
  }
  const auto captured = std::make_shared<CapturedContent>(CapturedContent{
      .content = *std::move(content), .marks = {}, .samples = frame.newest->frame.samples});
  if (request.marks != CaptureMarks::none) {
    auto marks = marks_of(frame);
    if (!marks) {
      request.done(marks.error());
      return true;
    }
    captured->marks = *std::move(marks);
  }
  post(std::make_shared<CaptureRequest>(std::move(request)), captured);
  return true;
}

/// Answers the request here where there is no memory for the task.
void FrameReaders::post(const std::shared_ptr<CaptureRequest>& request,
                        const std::shared_ptr<CapturedContent>& captured) {
  try {
    capture_writer_.post([request, captured, &written = written_] {
      answer(*request, *captured);
      written.notify();
    });
  } catch (const std::exception& failure) {
    log_error({.session = session_.name()},
              std::string("a capture could not be written: ") + failure.what());
    request->done(protocol::error::internal());
  }
}

void FrameReaders::fail_before_first_step() {
  const protocol::Error why =
      protocol::error::not_ready("no frame was rendered since lockstep was entered");
  std::erase_if(captures_, [&](const PendingCapture& capture) {
    if (session_.timeline().step_due(capture.request.ticket)) return false;
    capture.request.done(why);
    return true;
  });
  std::erase_if(probes_, [&](const PendingProbe& pending) {
    if (session_.timeline().step_due(pending.probe.ticket)) return false;
    pending.probe.fail(why);
    return true;
  });
}

void FrameReaders::fail_all(const protocol::Error& why) {
  for (const PendingCapture& capture : captures_) {
    // What was on its way out when memory ran out has been answered.
    if (capture.request.done) capture.request.done(why);
  }
  captures_.clear();
  for (const PendingProbe& pending : probes_) pending.probe.fail(why);
  probes_.clear();
}

void FrameReaders::drop_all() {
  captures_.clear();
  probes_.clear();
  session_.captures().take_captures();
  session_.captures().take_probes();
}

}  // namespace heliograph::session
