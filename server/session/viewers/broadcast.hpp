#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "session/measurements.hpp"
#include "session/rendering/rendered_frame.hpp"
#include "session/session.hpp"
#include "session/worker.hpp"
#include "stream/encoders/frame_encoder.hpp"

namespace heliograph::session {

/// What a broadcast works with.
struct BroadcastServices {
  Worker& encoder;
  stream::JpegEncoder& jpeg;
  Measurements& measurements;
  std::shared_ptr<WakeEvent> wake;  // notified when a frame has been encoded
  protocol::TracerKind tracer;
  /// Of the newest frame, which came without; empty: they are gone, and another frame comes.
  std::function<std::vector<std::uint8_t>()> read_pixels;
};

/// Sends the frames of one session to its viewers. Takes every rendered frame, picks those to send,
/// and has them encoded beside rendering, only for viewers that can accept a frame now and in the
/// variants that they request. While a static image refines it is sent when its samples have
/// doubled, after a few seconds, or when it shows another state; the final frame is sent once. For
/// the render thread.
class Broadcast {
 public:
  Broadcast(std::shared_ptr<Session> session, const BroadcastServices& services);

  /// A new frame. All but interactive ones are of a static image at full size.
  void rendered(std::shared_ptr<const RenderedFrame> frame, FramePurpose purpose);
  /// Releases the frames until there is another.
  void reset();
  /// Sends the newest frame as the final one.
  void send_final();
  /// Whether the newest frame was sent, or is due to be sent, as the final one.
  bool final_sent() const {
    return newest_ && due_purpose_ == FramePurpose::final && !newer_than_due_;
  }

  /// Begins to encode the frame that is due if a viewer can accept it. False if there is nothing to
  /// do.
  bool pump();
  /// Whether a frame waits until the one before is encoded: rendering is far enough ahead.
  bool behind() const { return encoding() && started_ != number_; }

 private:
  class CountedEncoding;
  struct Encoding;
  bool take_pixels();
  bool encoding() const { return *encoding_ != 0; }
  void send_newest(FramePurpose purpose);

  std::shared_ptr<Session> session_;
  BroadcastServices services_;
  std::shared_ptr<stream::FrameEncoder> encoder_;  // used by the task that encodes
  std::shared_ptr<std::atomic<int>> encoding_;     // tasks that are not done
  std::shared_ptr<const RenderedFrame> newest_;
  std::shared_ptr<const RenderedFrame> due_;  // to be sent
  FramePurpose due_purpose_ = FramePurpose::interactive;
  bool newer_than_due_ = false;  // newest_ is not sent yet
  std::uint64_t number_ = 0;     // of the due frame
  std::uint64_t started_ = 0;    // the last that was given to the encoder
  std::uint32_t due_samples_ = 0;
  std::uint32_t due_rev_ = 0;  // the state that it shows
  std::uint64_t due_start_us_ = 0;
};

}  // namespace heliograph::session
