#include "session/commands/commands.hpp"
#include "stream/encoders/base64.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::CapturedFrame;
using protocol::Empty;
using protocol::FrameBuffers;
using protocol::FrameCapture;
using protocol::Result;

namespace {

void capture(Session& session, const FrameCapture& request, const protocol::CallContext& context,
             protocol::Completion<CapturedFrame> done) {
  const auto answer = [request, done](Result<Capture> capture) {
    if (!capture) return done(capture.error());
    done(CapturedFrame{.buffer = request.buffer,
                       .format = request.format,
                       .width = capture->width,
                       .height = capture->height,
                       .samples = capture->samples,
                       .data = stream::base64_encode(capture->file)});
  };
  const CaptureMarks marks = request.marks ? CaptureMarks::drawn : CaptureMarks::none;
  const Result<void> accepted = session.captures().request_capture({.buffer = request.buffer,
                                                                    .format = request.format,
                                                                    .samples = request.samples,
                                                                    .marks = marks,
                                                                    .viewer = context.viewer,
                                                                    .answer = context.answer,
                                                                    .as_base64 = true,
                                                                    .done = answer});
  if (!accepted) done(accepted.error());
}

}  // namespace

void add_capture_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::frame_buffers>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) -> Result<FrameBuffers> {
        return FrameBuffers{.buffers = session.buffers()};
      });
  dispatcher.add<methods::frame_capture>([&](const FrameCapture& request,
                                             const protocol::CallContext& context,
                                             protocol::Completion<CapturedFrame> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    capture(**session, request, context, std::move(done));
  });
}

}  // namespace heliograph::session
