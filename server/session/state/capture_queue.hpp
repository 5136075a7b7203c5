#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/pending_answer.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/result.hpp"
#include "session/state/ticket.hpp"
#include "stream/drawing/mark_drawing.hpp"

namespace heliograph::render {
class Renderer;
}

namespace heliograph::session {

struct RenderState;

/// One buffer as a file.
struct Capture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  std::vector<std::uint8_t> file;
  stream::ImageMarks marks;  // if they were listed
};

/// The scene's measurements and annotations in a capture: drawn over the image, or left to the
/// caller to draw.
enum class CaptureMarks { none, drawn, listed };

struct CaptureRequest {
  std::string buffer = "output";
  protocol::ImageFormat format = protocol::ImageFormat::png;
  /// Samples to wait for; absent: until the image has converged.
  std::optional<std::uint32_t> samples;
  CaptureMarks marks = CaptureMarks::none;
  /// The viewer that asks; empty for a caller without a stream. Dropped when the viewer leaves.
  std::string viewer;
  /// What the file goes into; null: of any size. The capture is dropped where it is abandoned.
  std::shared_ptr<protocol::PendingAnswer> answer = nullptr;
  bool as_base64 = false;  // in that answer
  /// In lockstep only; given by the session.
  std::optional<Ticket> ticket;
  /// Called once, on any thread.
  std::function<void(protocol::Result<Capture>)> done;
  /// Given by the session: the request is pending for as long as this exists.
  std::shared_ptr<void> pending;
};

/// Something to read from a frame that shows a session's state, on the render thread.
struct Probe {
  /// Whether it reads buffers that not every frame keeps: render::Renderer::keep_buffers().
  bool reads_buffers = false;
  /// In lockstep only; given by the session.
  std::optional<Ticket> ticket;
  /// Called once, with the renderer right after it rendered that state. Must not block.
  std::function<void(render::Renderer&, const RenderState&)> read;
  /// Called instead where there is no such frame.
  std::function<void(protocol::Error)> fail;
};

/// Captures and probes on their way from commands to the render thread. Not thread safe, apart from
/// the release of CaptureRequest::pending.
class CaptureQueue {
 public:
  /// `limit` of unanswered captures; of probes that the render thread has not taken.
  explicit CaptureQueue(std::size_t limit) : limit_(limit) {}

  protocol::Result<void> check_capture_capacity() const;
  protocol::Result<void> check_probe_capacity() const;
  void add(CaptureRequest request);
  void add(Probe probe) { probes_.push_back(std::move(probe)); }
  /// Those added since the last call.
  std::vector<CaptureRequest> take_captures();
  std::vector<Probe> take_probes();
  /// The smallest ticket of those that are not taken.
  std::optional<Ticket> first_ticket() const;

 private:
  const std::size_t limit_;
  std::vector<CaptureRequest> captures_;
  std::vector<Probe> probes_;
  /// Captures that are not answered yet, in the queue or after it.
  const std::shared_ptr<std::atomic<std::size_t>> pending_captures_ =
      std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace heliograph::session
