#include "tests/bench/frame_playback.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace heliograph::bench {
namespace {

static_assert(shown_quality == session::default_quality);

/// Above all render ids of the session's own renderer, which draws a few empty frames.
constexpr int first_number = 1000;

/// Tiles under soft light that move slightly from frame to frame.
render::Frame draw(int number) {
  render::Frame frame{.width = shown_width, .height = shown_height};
  frame.rgba.resize(std::size_t{4} * shown_width * shown_height);
  std::uint32_t random = 12345u + static_cast<std::uint32_t>(number);
  for (std::uint32_t y = 0; y < shown_height; ++y) {
    for (std::uint32_t x = 0; x < shown_width; ++x) {
      const float u = static_cast<float>(x) + 8.0f * static_cast<float>(number);
      const float v = static_cast<float>(y);
      const bool tile = (static_cast<int>(u) / 64 + static_cast<int>(v) / 48) % 2 != 0;
      random = random * 1664525u + 1013904223u;
      const float grain = static_cast<float>(random >> 24) / 255.0f * 8.0f;
      const float light = 110.0f + 60.0f * std::sin(u * 0.011f) * std::cos(v * 0.017f) + grain;
      std::uint8_t* const pixel = &frame.rgba[std::size_t{4} * (y * shown_width + x)];
      pixel[0] = static_cast<std::uint8_t>(light * (tile ? 1.0f : 0.6f));
      pixel[1] = static_cast<std::uint8_t>(light * (tile ? 0.9f : 0.7f));
      pixel[2] = static_cast<std::uint8_t>(light * (tile ? 0.7f : 0.8f));
      pixel[3] = 255;
    }
  }
  return frame;
}

}  // namespace

std::vector<render::Frame> draw_frames(int count) {
  std::vector<render::Frame> frames;
  for (int i = 0; i < count; ++i) frames.push_back(draw(i));
  return frames;
}

FramePlayback::FramePlayback(session::SessionHost& host, std::vector<render::Frame> frames,
                             double rate)
    : worker_("encoder", 1),
      broadcast_(host.sessions().main(),
                 {.encoder = worker_,
                  .jpeg = jpeg_,
                  .measurements = measurements_,
                  .wake = wakeup_,
                  .tracer = host.devices().engine(0).tracer(),
                  .read_pixels = [] { return std::vector<std::uint8_t>(); }}),
      interval_(
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate))) {
  for (render::Frame& frame : frames) {
    auto rendered = std::make_shared<session::RenderedFrame>();
    rendered->frame = std::move(frame);
    frames_.push_back(std::move(rendered));
  }
  for (int i = 0; i < first_number; ++i)
    broadcast_.rendered(next_frame(), session::FramePurpose::interactive);
  thread_ = std::thread([this] { run(); });
}

FramePlayback::~FramePlayback() {
  stopping_ = true;
  thread_.join();
  worker_.stop();
}

/// Frames repeat long after their encoding.
std::shared_ptr<session::RenderedFrame> FramePlayback::next_frame() {
  const std::shared_ptr<session::RenderedFrame>& frame = frames_[shown_ % frames_.size()];
  protocol::FrameHeader& header = frame->header;
  header.render_id = ++shown_;
  header.full_width = shown_width;
  header.full_height = shown_height;
  header.render_start_us = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
          .count());
  return frame;
}

void FramePlayback::run() {
  Clock::time_point next = Clock::now();
  while (!stopping_) {
    next = std::max(next + interval_, Clock::now() - interval_);
    std::this_thread::sleep_until(next);
    if (!running_ || broadcast_.behind()) continue;
    broadcast_.rendered(next_frame(), session::FramePurpose::interactive);
    broadcast_.pump();
  }
}

}  // namespace heliograph::bench
