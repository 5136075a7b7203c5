#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "protocol/messages/messages.hpp"
#include "session/measurements.hpp"
#include "session/rendering/rendered_frame.hpp"
#include "session/state/session.hpp"
#include "session/worker.hpp"
#include "stream/encoders/frame_encoder.hpp"

namespace heliograph::session {

/// What a broadcast works with.
struct BroadcastServices {
  Worker& encoder;
  stream::JpegEncoder& jpeg;  // used by `encoder` only
  Measurements& measurements;
  std::shared_ptr<WakeEvent> wakeup;  // notified when a picture has been encoded
  protocol::TracerKind tracer;
};

/// Sends the pictures of one session to its viewers. Takes every picture that is rendered, picks
/// those worth sending, and has them encoded beside rendering, for viewers who can take them now
/// and only in the forms that they want. While a resting picture refines it is sent when its
/// samples have doubled or the state is another; the final one is sent once, and after it nothing.
/// For the render thread.
class Broadcast {
 public:
  Broadcast(std::shared_ptr<Session> session, const BroadcastServices& services);

  /// A new picture. `resting`: nothing moves and it is drawn whole.
  void rendered(std::shared_ptr<const RenderedFrame> picture, bool resting);
  /// Keeps no picture and nothing else of size until there is another.
  void forget();
  /// The newest picture is final.
  void finish();
  bool finished() const { return newest_ && due_purpose_ == Purpose::final && !newer_than_due_; }

  /// Begins to encode the newest picture worth sending if a viewer could take it. False if there is
  /// nothing to do.
  bool pump();
  /// Whether a picture waits until the one before is encoded: rendering is far enough ahead.
  bool behind() const { return encoding() && started_ != number_; }

 private:
  struct Encoding;
  bool encoding() const { return *encoding_ != 0; }
  void due(Purpose purpose);

  std::shared_ptr<Session> session_;
  BroadcastServices services_;
  std::shared_ptr<stream::FrameEncoder> encoder_;  // used by the encoding thread
  std::shared_ptr<std::atomic<int>> encoding_;     // tasks that are not done
  std::shared_ptr<const RenderedFrame> newest_;
  std::shared_ptr<const RenderedFrame> due_;
  Purpose due_purpose_ = Purpose::interactive;
  bool newer_than_due_ = false;  // newest_ is not worth sending yet
  std::uint64_t number_ = 0;     // of the due picture
  std::uint64_t started_ = 0;    // the last that was given to the encoder
  std::uint32_t due_samples_ = 0;
  std::uint32_t due_rev_ = 0;  // the state that it shows
};

}  // namespace heliograph::session
