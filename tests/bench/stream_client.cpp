#include "tests/bench/stream_client.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>

#include "tests/bench/viewers/viewer_socket.hpp"

namespace heliograph::bench {
namespace {

using Clock = std::chrono::steady_clock;

class Viewer {
 public:
  explicit Viewer(std::uint16_t port) : socket_(port) {
    socket_.send_text(R"({"jsonrpc":"2.0","method":"stream.configure","params":{"max_fps":240}})");
  }

  int descriptor() const { return socket_.descriptor(); }

  /// Reads the bytes that have arrived.
  void read(ClientReport& report) {
    report.bytes += socket_.read([&](const ReceivedFrame& frame) { took(frame, report); });
  }

  std::uint64_t frames = 0;

 private:
  void took(const ReceivedFrame& frame, ClientReport& report) {
    const protocol::FrameHeader& header = frame.header;
    if (header.full_width != shown_width) return;  // rendered by the session itself
    const double overhead = frame.first_byte_us - static_cast<double>(header.render_start_us) -
                            header.render_us - header.encode_us;
    report.overhead_ms.push_back(overhead / 1000.0);
    report.disorder += header.frame_seq <= last_seq_ || header.render_id < last_render_;
    report.adapted += header.width != shown_width || header.quality != shown_quality;
    last_seq_ = header.frame_seq;
    last_render_ = header.render_id;
    ++frames;
  }

  ViewerSocket socket_;
  std::uint32_t last_seq_ = 0;
  std::uint32_t last_render_ = 0;
};

class Crowd {
 public:
  explicit Crowd(const ClientOptions& options) {
    for (std::size_t i = 0; i < options.viewers; ++i) {
      reading_.push_back(std::make_unique<Viewer>(options.port));
    }
    for (std::size_t i = 0; i < options.stalled; ++i) {
      stalled_.push_back(std::make_unique<Viewer>(options.port));
    }
  }

  template <class Done>
  void run_until(ClientReport& report, Done done) {
    while (!done()) {
      std::vector<pollfd> waiting;
      for (const auto& viewer : reading_) {
        waiting.push_back({.fd = viewer->descriptor(), .events = POLLIN, .revents = 0});
      }
      constexpr int look_up_every_ms = 50;
      poll(waiting.data(), waiting.size(), look_up_every_ms);
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        if (waiting[i].revents != 0) reading_[i]->read(report);
      }
    }
  }

  void run_for(ClientReport& report, double seconds) {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    run_until(report, [&] { return Clock::now() >= end; });
  }

  bool all_have_frames() const {
    return std::all_of(reading_.begin(), reading_.end(),
                       [](const auto& viewer) { return viewer->frames > 0; });
  }

  void forget_frames() {
    for (const auto& viewer : reading_) viewer->frames = 0;
  }

  std::vector<std::uint64_t> frames() const {
    std::vector<std::uint64_t> counts;
    for (const auto& viewer : reading_) counts.push_back(viewer->frames);
    return counts;
  }

 private:
  std::vector<std::unique_ptr<Viewer>> reading_;
  std::vector<std::unique_ptr<Viewer>> stalled_;
};

}  // namespace

ClientReport watch(const ClientOptions& options, const std::function<void(bool)>& tell) {
  Crowd crowd(options);
  ClientReport before;
  const auto deadline = Clock::now() + std::chrono::seconds(20);
  crowd.run_until(before, [&] {
    if (Clock::now() > deadline) throw std::runtime_error("a viewer received no frame");
    return crowd.all_have_frames();
  });
  tell(false);
  crowd.run_for(before, options.settle);
  crowd.forget_frames();
  tell(true);
  ClientReport report;
  crowd.run_for(report, options.seconds);
  report.frames = crowd.frames();
  return report;
}

}  // namespace heliograph::bench
