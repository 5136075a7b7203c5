#include "tests/bench/viewers/moving_viewer.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <span>
#include <utility>

#include "tests/bench/viewers/viewer_socket.hpp"

namespace heliograph::bench {
namespace {

constexpr double us = 1e6;  // in a second
/// Back and forth, so that the camera stays in the scene.
constexpr std::size_t inputs_of_a_swing = 100;
constexpr double degrees_of_an_input = 0.2;

/// Whether a JPEG defines restart intervals (ITU-T T.81, section B.2.4.4).
bool has_restart_intervals(std::span<const std::uint8_t> file) {
  constexpr std::uint8_t define_interval = 0xdd;
  constexpr std::uint8_t start_of_scan = 0xda;
  for (std::size_t i = 2; i + 4 <= file.size() && file[i] == 0xff;) {
    if (file[i + 1] == define_interval) return true;
    if (file[i + 1] == start_of_scan) return false;
    i += 2 + (std::size_t{file[i + 2]} << 8 | file[i + 3]);
  }
  return false;
}

class MovingViewer {
 public:
  explicit MovingViewer(const MovingOptions& options) : options_(options), socket_(options.port) {
    socket_.send_text(fmt::format(
        R"({{"jsonrpc":"2.0","method":"stream.configure","params":{{"width":{},"height":{},)"
        R"("quality":{},"max_fps":{}}}}})",
        options.width, options.height, options.quality, options.max_fps));
  }

  void run_for(double seconds) {
    const double end = now_us() + seconds * us;
    next_input_us_ = std::max(next_input_us_, now_us());
    for (double now = now_us(); now < end; now = now_us()) {
      if (input_is_due(now)) send_input(now);
      const double next = waits_for_frames() ? end : std::min(end, next_input_us_);
      pollfd waiting{.fd = socket_.descriptor(), .events = POLLIN, .revents = 0};
      const double left = std::max(next - now_us(), 0.0);
      const timespec most{static_cast<time_t>(left / us),
                          static_cast<long>(1e3 * (left - us * static_cast<long>(left / us)))};
      ppoll(&waiting, 1, &most, nullptr);
      if (waiting.revents != 0) socket_.read([this](const ReceivedFrame& frame) { took(frame); });
    }
  }

  std::vector<ShownFrame> take_frames() { return std::exchange(frames_, {}); }

 private:
  bool waits_for_frames() const { return options_.inputs == 0.0; }
  bool input_is_due(double now) const {
    return waits_for_frames() ? shown_ == sent_us_.size() : now >= next_input_us_;
  }

  void send_input(double now) {
    const bool back = sent_us_.size() / inputs_of_a_swing % 2 != 0;
    sent_us_.push_back(now);
    if (!waits_for_frames()) next_input_us_ += us / options_.inputs;
    socket_.send_text(
        fmt::format(R"({{"jsonrpc":"2.0","method":"camera.orbit","params":{{"yaw":{},"seq":{}}}}})",
                    back ? -degrees_of_an_input : degrees_of_an_input, sent_us_.size()));
  }

  void took(const ReceivedFrame& frame) {
    ShownFrame shown{.header = frame.header,
                     .bytes = frame.payload.size(),
                     .by_device = frame.header.codec == protocol::FrameCodec::jpeg &&
                                  has_restart_intervals(frame.payload),
                     .received_us = now_us()};
    const std::size_t echoed = std::min<std::size_t>(frame.header.input_seq_echo, sent_us_.size());
    for (; shown_ < echoed; ++shown_) {
      shown.input_ms.push_back((shown.received_us - sent_us_[shown_]) / 1e3);
      shown.wait_ms = (static_cast<double>(frame.header.render_start_us) - sent_us_[shown_]) / 1e3;
    }
    frames_.push_back(std::move(shown));
  }

  const MovingOptions& options_;
  ViewerSocket socket_;
  std::vector<double> sent_us_;  // of each input
  std::size_t shown_ = 0;        // inputs that a frame has shown
  double next_input_us_ = 0.0;
  std::vector<ShownFrame> frames_;
};

}  // namespace

std::vector<ShownFrame> move_and_watch(const MovingOptions& options,
                                       const std::function<void()>& begins) {
  MovingViewer viewer(options);
  viewer.run_for(options.settle);
  viewer.take_frames();
  begins();
  viewer.run_for(options.seconds);
  return viewer.take_frames();
}

}  // namespace heliograph::bench
