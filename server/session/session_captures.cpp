#include "session/session_captures.hpp"

#include <cstddef>
#include <utility>

#include "render/api/buffer_names.hpp"
#include "session/measurements.hpp"
#include "session/rendering/capture_content.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

Result<void> check_marks(const CaptureRequest& request) {
  if (request.marks == CaptureMarks::none) return {};
  if (request.marks == CaptureMarks::drawn && !is_image_of_output(request.buffer, request.format)) {
    return protocol::error::invalid("marks", "are possible in images of output only",
                                    "png, jpeg or webp of the buffer output");
  }
  if (const auto& reason = stream::marks_unavailable()) {
    return protocol::error::invalid("marks", "cannot be drawn: " + *reason);
  }
  return {};
}

}  // namespace

Result<void> SessionCaptures::request_capture(CaptureRequest request) {
  const Result<void> accepted = accept(std::move(request));
  if (accepted) {
    core_.wake->notify();
  } else if (core_.measurements) {
    core_.measurements->capture_failed();
  }
  return accepted;
}

Result<void> SessionCaptures::accept(CaptureRequest request) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  if (const auto known = render::check_buffer_name(request.buffer, "buffer"); !known) {
    return known.error();
  }
  if (const auto possible = check_marks(request); !possible) return possible;
  if (const auto capacity = core_.captures.check_capture_capacity(); !capacity) return capacity;
  if (request.answer) {
    const std::size_t file =
        estimated_file_bytes(request.buffer, request.format, core_.width, core_.height);
    const auto room = request.answer->reserve(request.as_base64 ? file / 3 * 4 : file);
    if (!room) return room;
  }
  request.ticket = core_.timeline.next_ticket();
  core_.captures.add(std::move(request));
  return {};
}

Result<void> SessionCaptures::request_probe(Probe probe) {
  {
    const std::lock_guard lock(core_.mutex);
    if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
    if (const auto capacity = core_.captures.check_probe_capacity(); !capacity) return capacity;
    probe.ticket = core_.timeline.next_ticket();
    core_.captures.add(std::move(probe));
  }
  core_.wake->notify();
  return {};
}

std::vector<CaptureRequest> SessionCaptures::take_captures() {
  const std::lock_guard lock(core_.mutex);
  return core_.captures.take_captures();
}

std::vector<Probe> SessionCaptures::take_probes() {
  const std::lock_guard lock(core_.mutex);
  return core_.captures.take_probes();
}

}  // namespace heliograph::session
