#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "session/session_host.hpp"
#include "session/viewers/broadcast.hpp"
#include "tests/bench/stream_client.hpp"

namespace heliograph::bench {

/// Frames of a short animation with different grain: encoded about as large as a rendered interior.
std::vector<render::Frame> draw_frames(int count);

/// Publishes prerendered frames at a steady rate in a session whose own renderer is idle, through
/// the encoding and sending of every session.
class FramePlayback {
 public:
  /// `rate`: frames per second.
  FramePlayback(session::SessionHost& host, std::vector<render::Frame> frames, double rate);
  ~FramePlayback();
  FramePlayback(const FramePlayback&) = delete;
  FramePlayback& operator=(const FramePlayback&) = delete;

  void set_running(bool running) { running_ = running; }
  std::uint64_t encodings() const { return measurements_.totals().encodings.count(); }

 private:
  using Clock = std::chrono::steady_clock;

  std::shared_ptr<session::RenderedFrame> next_frame();
  void run();

  stream::JpegEncoder jpeg_;
  session::Measurements measurements_;
  session::Worker worker_;
  const std::shared_ptr<session::WakeEvent> wakeup_ = std::make_shared<session::WakeEvent>();
  session::Broadcast broadcast_;
  std::vector<std::shared_ptr<session::RenderedFrame>> frames_;
  std::uint32_t shown_ = 0;
  const Clock::duration interval_;
  std::atomic<bool> running_ = false;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace heliograph::bench
