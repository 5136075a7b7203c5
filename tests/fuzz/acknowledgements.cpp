// Each byte is a step of a viewer or of the server: frames offered and taken, acknowledged in any
// order with any times, pauses, other rates. At no time may more than a window be in flight, an
// acknowledgement count twice, or an estimate leave the numbers.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <span>

#include "stream/pacing/viewer_pacer.hpp"

using namespace heliograph;
using namespace std::chrono_literals;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Numbers for the steps, from the bytes of the input; zero at its end.
class Numbers {
 public:
  explicit Numbers(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  template <class Number>
  Number next() {
    Number number = 0;
    const std::size_t size = std::min(sizeof(Number), bytes_.size());
    std::memcpy(&number, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return number;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

class Viewer {
 public:
  void step(Numbers& numbers) {
    switch (numbers.next<std::uint8_t>() % 9) {
      case 0:
        return offer(numbers);
      case 1:
        return take();
      case 2:
        return acknowledge(last_taken_, numbers);
      case 3:
        return acknowledge(numbers.next<std::uint32_t>(), numbers);
      case 4:
        now_ += std::chrono::microseconds(numbers.next<std::uint32_t>());
        return;
      case 5:
        return pacer_.set_paused(numbers.next<std::uint8_t>() % 2 != 0, now_);
      // The range that stream.configure accepts.
      case 6:
        return pacer_.set_max_rate(1.0 + numbers.next<std::uint8_t>() % 240);
      case 7:
        return pacer_.skip();
      default:
        return pacer_.drop_pending();
    }
  }

  void check() const {
    require(pacer_.in_flight() <= stream::max_ack_window);
    require(pacer_.in_flight() == in_flight_.size());
    require(pacer_.round_trip() >= 0us);
    require(std::isfinite(pacer_.goodput()) && pacer_.goodput() >= 0.0);
    require(pacer_.link().budget() > 0.0);
    require(pacer_.link().base_delay() >= 0us);
    const stream::PacerTotals& totals = pacer_.totals();
    require(totals.acknowledged + pacer_.in_flight() == totals.frames);
    require(!(pacer_.has_room(now_) && pacer_.sendable(now_)));
  }

 private:
  void offer(Numbers& numbers) {
    auto frame = std::make_shared<stream::EncodedFrame>();
    const auto kind = numbers.next<std::uint8_t>();
    frame->moving = kind % 2 != 0;
    frame->payload.resize(numbers.next<std::uint16_t>());
    frame->header.render_us = numbers.next<std::uint32_t>();
    frame->variant = pacer_.link().choose({}, 1280 * 720);
    require(frame->variant.quality >= 1 && frame->variant.quality <= 100);
    require(frame->variant.scale >= 1 && frame->variant.scale <= 100);
    if (kind & 2) {
      frame->variant.codec = protocol::StreamCodec::h264;
      frame->video = stream::VideoPosition{.video = 1, .index = video_index_++};
      if (kind & 4) frame->header.flags = protocol::frame_flag::key;
    }
    if (pacer_.can_show(*frame)) {
      pacer_.offer(frame);
    } else {
      pacer_.skip();
    }
  }

  void take() {
    const bool sendable = pacer_.sendable(now_);
    const auto taken = pacer_.take(now_);
    require(taken.has_value() == sendable);
    if (!taken) return;
    require(taken->frame_seq > last_taken_ && taken->frame != nullptr);
    last_taken_ = taken->frame_seq;
    in_flight_.insert(last_taken_);
  }

  void acknowledge(std::uint32_t frame_seq, Numbers& numbers) {
    const bool known = in_flight_.contains(frame_seq);
    require(pacer_.acknowledge(frame_seq, std::chrono::microseconds(numbers.next<std::int64_t>()),
                               now_) == known);
    if (known) in_flight_.erase(in_flight_.begin(), in_flight_.upper_bound(frame_seq));
  }

  stream::ViewerPacer pacer_;
  stream::Clock::time_point now_ = stream::Clock::time_point(1h);
  std::set<std::uint32_t> in_flight_;
  std::uint32_t last_taken_ = 0;
  std::uint32_t video_index_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers numbers({data, size});
  Viewer viewer;
  while (!numbers.empty()) {
    viewer.step(numbers);
    viewer.check();
  }
  return 0;
}
