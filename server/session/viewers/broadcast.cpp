#include "session/viewers/broadcast.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/messages/frame_depth.hpp"
#include "stream/encoders/byte_compression.hpp"

namespace heliograph::session {

using std::chrono::duration_cast;
using std::chrono::microseconds;

namespace {

/// Of frames of a static image whose samples take long to double.
constexpr microseconds longest_refining_interval = std::chrono::seconds(4);

protocol::StreamPhase phase_of(FramePurpose purpose) {
  switch (purpose) {
    case FramePurpose::interactive:
      return protocol::StreamPhase::interactive;
    case FramePurpose::refining:
      return protocol::StreamPhase::refining;
    case FramePurpose::final:
      return protocol::StreamPhase::idle;
  }
  return protocol::StreamPhase::interactive;
}

protocol::StatsFrame stats_of(const RenderedFrame& frame, protocol::TracerKind tracer,
                              protocol::StreamPhase phase) {
  return {.render_id = frame.header.render_id,
          .fps = frame.fps,
          .frame_ms = frame.frame.milliseconds,
          .width = frame.frame.width,
          .height = frame.frame.height,
          .samples = frame.frame.samples,
          .tracer = tracer,
          .state = phase,
          .passes = pass_timings(frame.frame)};
}

std::shared_ptr<const std::vector<std::uint8_t>> encode_depth(const protocol::FrameDepth& depth) {
  const auto compressed =
      stream::compress_bytes(protocol::depth_differences(depth.samples, depth.width));
  return std::make_shared<const std::vector<std::uint8_t>>(
      protocol::encode_frame_depth(depth, compressed));
}

/// The header of the rendered frame with what the encoder adds.
protocol::FrameHeader merged(const protocol::FrameHeader& rendered,
                             const protocol::FrameHeader& encoded) {
  protocol::FrameHeader header = rendered;
  header.codec = encoded.codec;
  header.quality = encoded.quality;
  header.width = encoded.width;
  header.height = encoded.height;
  header.flags |= encoded.flags;
  return header;
}

/// What the device has encoded of the frame.
std::optional<stream::EncodingVariant> device_jpeg(const render::Frame& frame) {
  if (frame.jpeg.bytes.empty()) return std::nullopt;
  return stream::EncodingVariant{.scale = frame.jpeg.made.percent,
                                 .quality = frame.jpeg.made.quality};
}

bool is_device_jpeg(const render::Frame& frame, const stream::VariantRequest& request) {
  return device_jpeg(frame) == request.variant;
}

/// Whether the frame comes with all that is sent of it.
bool suffices(const render::Frame& frame, const EncodingPlan& plan) {
  return !frame.rgba.empty() ||
         (plan.stills.empty() && std::ranges::all_of(plan.requests, [&](const auto& request) {
            return is_device_jpeg(frame, request);
          }));
}

}  // namespace

/// Counts an encoding for as long as it exists: until it has run, has failed, or was not given to
/// the encoder for want of memory.
class Broadcast::CountedEncoding {
 public:
  CountedEncoding(std::shared_ptr<std::atomic<int>> count, std::shared_ptr<WakeEvent> wake)
      : count_(std::move(count)), wake_(std::move(wake)) {
    ++*count_;
  }
  ~CountedEncoding() {
    --*count_;
    wake_->notify();
  }
  CountedEncoding(const CountedEncoding&) = delete;
  CountedEncoding& operator=(const CountedEncoding&) = delete;

 private:
  std::shared_ptr<std::atomic<int>> count_;
  std::shared_ptr<WakeEvent> wake_;
};

/// One frame that is encoded, on the thread of the encoder.
struct Broadcast::Encoding {
  std::shared_ptr<Session> session;
  BroadcastServices services;
  std::shared_ptr<stream::FrameEncoder> encoder;
  std::shared_ptr<CountedEncoding> counted;
  std::shared_ptr<const RenderedFrame> rendered;
  FramePurpose purpose;
  std::uint64_t number;
  EncodingPlan plan;
  std::shared_ptr<const std::vector<std::uint8_t>> depth{};
  protocol::PassKind encoded_by = protocol::PassKind::host;

  void run() {
    std::vector<stream::SharedFrame> frames;
    try {
      frames = encode_for_purpose();
    } catch (...) {
      // Otherwise viewers would wait for this frame.
      finish({});
      throw;
    }
    finish(std::move(frames));
  }

  void finish(std::vector<stream::SharedFrame> frames) {
    ViewerSet& viewers = session->viewers();
    viewers.publish(number, purpose, std::move(frames));
    protocol::StatsFrame stats = stats_of(*rendered, services.tracer, phase_of(purpose));
    stats.encoder = encoded_by;
    viewers.publish_stats(std::move(stats));
    counted.reset();
  }

  /// No other frame of a static image may follow: once more where there was no memory.
  std::vector<stream::SharedFrame> encode_for_purpose() {
    if (purpose == FramePurpose::interactive) return encode();
    try {
      return encode();
    } catch (const std::bad_alloc&) {
      return encode();
    }
  }

  std::vector<stream::SharedFrame> encode() {
    const render::Frame& frame = rendered->frame;
    const stream::ImageView view = image_view(frame);
    std::vector<stream::SharedFrame> frames;
    if (rendered->depth) depth = encode_depth(*rendered->depth);
    for (const stream::VariantRequest& request : plan.requests) {
      if (is_device_jpeg(frame, request)) {
        encoded_by = protocol::PassKind::device;
        frames.push_back(timed(encoded_by, [&] {
          return stream::FrameEncoder::wrap_jpeg(frame.jpeg.width, frame.jpeg.height,
                                                 request.variant, frame.jpeg.bytes);
        }));
      } else {
        frames.push_back(
            timed(protocol::PassKind::host, [&] { return encoder->encode(view, request); }));
      }
    }
    for (const protocol::StillFormat format : plan.stills) {
      frames.push_back(timed(protocol::PassKind::host, [&] {
        return encoder->encode_still(view, format, plan.still_quality);
      }));
    }
    return frames;
  }

  template <class Encode>
  stream::SharedFrame timed(protocol::PassKind by, Encode encode) {
    const Clock::time_point start = Clock::now();
    const std::shared_ptr<stream::EncodedFrame> frame = encode();
    frame->encoded_at = Clock::now();
    frame->inputs = rendered->inputs;
    frame->cuts = rendered->discontinuities;
    frame->depth = depth;
    frame->moving = purpose == FramePurpose::interactive;
    frame->header = merged(rendered->header, frame->header);
    const auto taken = frame->encoded_at - start;
    frame->header.encode_us =
        static_cast<std::uint32_t>(duration_cast<microseconds>(taken).count());
    services.measurements.encoded(std::chrono::duration<double>(taken).count(), by);
    return frame;
  }
};

Broadcast::Broadcast(std::shared_ptr<Session> session, const BroadcastServices& services)
    : session_(std::move(session)),
      services_(services),
      encoder_(std::make_shared<stream::FrameEncoder>(services.jpeg)),
      encoding_(std::make_shared<std::atomic<int>>(0)) {}

void Broadcast::rendered(std::shared_ptr<const RenderedFrame> frame, FramePurpose purpose) {
  newest_ = std::move(frame);
  newer_than_due_ = true;
  const std::uint32_t samples = newest_->header.sample_count;
  const bool other_state = samples < due_samples_ || newest_->header.state_rev != due_rev_;
  if (purpose == FramePurpose::interactive) {
    send_newest(FramePurpose::interactive);
  } else if (other_state || samples >= 2 * due_samples_ ||
             microseconds(newest_->header.render_start_us - due_start_us_) >=
                 longest_refining_interval) {
    send_newest(FramePurpose::refining);
  } else {
    session_->viewers().publish_stats(
        stats_of(*newest_, services_.tracer, protocol::StreamPhase::refining));
  }
}

void Broadcast::reset() {
  newest_.reset();
  due_.reset();
  due_samples_ = 0;
  newer_than_due_ = false;
  encoder_ = std::make_shared<stream::FrameEncoder>(services_.jpeg);
}

void Broadcast::send_final() {
  send_newest(FramePurpose::final);
}

void Broadcast::send_newest(FramePurpose purpose) {
  due_ = newest_;
  due_purpose_ = purpose;
  due_samples_ = newest_->header.sample_count;
  due_rev_ = newest_->header.state_rev;
  due_start_us_ = newest_->header.render_start_us;
  newer_than_due_ = false;
  ++number_;
}

/// For what is due: those of the newest frame, which shows the same with as many samples or more.
bool Broadcast::take_pixels() {
  if (newest_->frame.rgba.empty()) {
    std::vector<std::uint8_t> pixels = services_.read_pixels();
    if (pixels.empty()) return false;
    auto complete = std::make_shared<RenderedFrame>(*newest_);
    complete->frame.rgba = std::move(pixels);
    newest_ = std::move(complete);
  }
  due_ = newest_;
  due_samples_ = due_->header.sample_count;
  return true;
}

bool Broadcast::pump() {
  if (!due_ || encoding() || !services_.encoder.has_room()) return false;
  if (!session_->viewers().needs_frame(number_)) return false;
  const render::Frame& frame = due_->frame;
  const std::uint64_t pixels = std::uint64_t{frame.width} * frame.height;
  EncodingPlan plan = session_->viewers().plan(number_, due_purpose_, pixels, device_jpeg(frame));
  if (!suffices(frame, plan) && !take_pixels()) {
    due_.reset();
    due_samples_ = 0;  // the next frame is sent, however few samples it adds
    return false;
  }
  auto counted = std::make_shared<CountedEncoding>(encoding_, services_.wake);
  started_ = number_;
  return services_.encoder.post(
      [encoding = Encoding{.session = session_,
                           .services = services_,
                           .encoder = encoder_,
                           .counted = std::move(counted),
                           .rendered = due_,
                           .purpose = due_purpose_,
                           .number = number_,
                           .plan = std::move(plan)}]() mutable { encoding.run(); });
}

}  // namespace heliograph::session
