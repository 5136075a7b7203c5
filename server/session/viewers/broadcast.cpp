#include "session/viewers/broadcast.hpp"

#include <utility>
#include <vector>

namespace heliograph::session {

using std::chrono::duration_cast;
using std::chrono::microseconds;

namespace {

std::vector<protocol::PassTiming> pass_timings(const std::vector<render::PassTime>& passes) {
  std::vector<protocol::PassTiming> result;
  for (const render::PassTime& pass : passes) {
    result.push_back({.name = pass.name, .kind = pass.kind, .ms = pass.milliseconds});
  }
  return result;
}

protocol::StreamPhase phase_of(Purpose purpose) {
  switch (purpose) {
    case Purpose::interactive:
      return protocol::StreamPhase::interactive;
    case Purpose::refining:
      return protocol::StreamPhase::refining;
    case Purpose::final:
      return protocol::StreamPhase::idle;
  }
  return protocol::StreamPhase::interactive;
}

protocol::StatsFrame stats_of(const RenderedFrame& picture, protocol::TracerKind tracer,
                              protocol::StreamPhase phase) {
  return {.render_id = picture.header.render_id,
          .fps = picture.fps,
          .frame_ms = picture.frame.milliseconds,
          .width = picture.frame.width,
          .height = picture.frame.height,
          .samples = picture.frame.samples,
          .tracer = tracer,
          .state = phase,
          .passes = pass_timings(picture.frame.passes)};
}

/// The header of the picture with what the encoder says of its form.
protocol::FrameHeader merged(const protocol::FrameHeader& picture,
                             const protocol::FrameHeader& encoded) {
  protocol::FrameHeader header = picture;
  header.codec = encoded.codec;
  header.quality = encoded.quality;
  header.width = encoded.width;
  header.height = encoded.height;
  header.flags |= encoded.flags;
  return header;
}

}  // namespace

/// One picture on its way through the encoder; carried out on its thread.
struct Broadcast::Encoding {
  std::shared_ptr<Session> session;
  BroadcastServices services;
  std::shared_ptr<stream::FrameEncoder> encoder;
  std::shared_ptr<std::atomic<int>> count;
  std::shared_ptr<const RenderedFrame> picture;
  Purpose purpose;
  std::uint64_t number;

  void run() {
    std::vector<stream::SharedFrame> frames;
    try {
      frames = encode();
    } catch (...) {
      // Nobody must wait for it.
      finish({});
      throw;
    }
    finish(std::move(frames));
  }

  void finish(std::vector<stream::SharedFrame> frames) {
    ViewerSet& audience = session->viewers();
    audience.publish(number, purpose, std::move(frames));
    audience.publish_stats(stats_of(*picture, services.tracer, phase_of(purpose)));
    --*count;
    services.wakeup->notify();
  }

  std::vector<stream::SharedFrame> encode() {
    const stream::ImageView view = image_view(picture->frame);
    const EncodingPlan plan = session->viewers().plan(number, purpose, view.rgba.size() / 4);
    std::vector<stream::SharedFrame> frames;
    for (const stream::VariantRequest& request : plan.requests) {
      frames.push_back(timed([&] { return encoder->encode(view, request); }));
    }
    for (const protocol::StillFormat format : plan.stills) {
      frames.push_back(
          timed([&] { return encoder->encode_still(view, format, plan.still_quality); }));
    }
    return frames;
  }

  template <class Encode>
  stream::SharedFrame timed(Encode encode) {
    const Clock::time_point start = Clock::now();
    const std::shared_ptr<stream::EncodedFrame> frame = encode();
    frame->encoded_at = Clock::now();
    frame->inputs = picture->inputs;
    frame->cuts = picture->cuts;
    frame->moving = purpose == Purpose::interactive;
    frame->header = merged(picture->header, frame->header);
    const auto taken = frame->encoded_at - start;
    frame->header.encode_us =
        static_cast<std::uint32_t>(duration_cast<microseconds>(taken).count());
    services.measurements.encoded(std::chrono::duration<double>(taken).count());
    return frame;
  }
};

Broadcast::Broadcast(std::shared_ptr<Session> session, const BroadcastServices& services)
    : session_(std::move(session)),
      services_(services),
      encoder_(std::make_shared<stream::FrameEncoder>(services.jpeg)),
      encoding_(std::make_shared<std::atomic<int>>(0)) {}

void Broadcast::rendered(std::shared_ptr<const RenderedFrame> picture, bool resting) {
  newest_ = std::move(picture);
  newer_than_due_ = true;
  const std::uint32_t samples = newest_->header.sample_count;
  const bool anew = samples < due_samples_ || newest_->header.state_rev != due_rev_;
  if (!resting) {
    due(Purpose::interactive);
  } else if (anew || samples >= 2 * due_samples_) {
    due(Purpose::refining);
  } else {
    session_->viewers().publish_stats(
        stats_of(*newest_, services_.tracer, protocol::StreamPhase::refining));
  }
}

void Broadcast::forget() {
  newest_.reset();
  due_.reset();
  due_samples_ = 0;
  newer_than_due_ = false;
  encoder_ = std::make_shared<stream::FrameEncoder>(services_.jpeg);
}

void Broadcast::finish() {
  due(Purpose::final);
}

void Broadcast::due(Purpose purpose) {
  due_ = newest_;
  due_purpose_ = purpose;
  due_samples_ = newest_->header.sample_count;
  due_rev_ = newest_->header.state_rev;
  newer_than_due_ = false;
  ++number_;
}

bool Broadcast::pump() {
  if (!due_ || encoding() || !services_.encoder.has_room()) return false;
  if (!session_->viewers().needs_frame(number_)) return false;
  started_ = number_;
  ++*encoding_;
  const bool posted = services_.encoder.post(
      [encoding = Encoding{.session = session_,
                           .services = services_,
                           .encoder = encoder_,
                           .count = encoding_,
                           .picture = due_,
                           .purpose = due_purpose_,
                           .number = number_}]() mutable { encoding.run(); });
  if (!posted) --*encoding_;
  return posted;
}

}  // namespace heliograph::session
