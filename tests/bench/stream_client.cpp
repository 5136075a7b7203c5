#include "tests/bench/stream_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <utility>

#include "protocol/frame_header.hpp"

namespace heliograph::bench {
namespace {

using Clock = std::chrono::steady_clock;

double now_us() {
  return std::chrono::duration<double, std::micro>(Clock::now().time_since_epoch()).count();
}

/// One WebSocket, read as its bytes come.
class Viewer {
 public:
  explicit Viewer(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("the server cannot be reached");
    }
    const int on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    write("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
          "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
          "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
          "Sec-WebSocket-Protocol: heliograph.v1\r\n\r\n");
    send_text(R"({"jsonrpc":"2.0","id":1,"method":"hello","params":{"client":"benchmark"}})");
    send_text(R"({"jsonrpc":"2.0","method":"stream.configure","params":{"max_fps":240}})");
  }
  ~Viewer() { close(socket_); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  int descriptor() const { return socket_; }

  /// Takes what has arrived.
  void read(ClientReport& report) {
    char chunk[1 << 16];
    const ssize_t count = recv(socket_, chunk, sizeof chunk, MSG_DONTWAIT);
    if (count == 0) throw std::runtime_error("the server has closed the connection");
    if (count < 0) return;
    if (received_.empty()) first_byte_us_ = now_us();
    received_.append(chunk, static_cast<std::size_t>(count));
    report.bytes += static_cast<std::uint64_t>(count);
    while (take_message(report)) first_byte_us_ = now_us();
  }

  std::uint64_t frames = 0;

 private:
  bool take_message(ClientReport& report) {
    if (!upgraded_) {
      const std::size_t end = received_.find("\r\n\r\n");
      if (end == std::string::npos) return false;
      upgraded_ = received_.starts_with("HTTP/1.1 101");
      if (!upgraded_) throw std::runtime_error("the server refuses the WebSocket");
      received_.erase(0, end + 4);
      return true;
    }
    if (received_.size() < 2) return false;
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(received_[i]); };
    std::size_t head = 2;
    std::uint64_t size = byte(1) & 127;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (received_.size() < head + more) return false;
    if (more > 0) size = 0;
    for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte(head + i);
    head += more;
    if (received_.size() < head + size) return false;
    constexpr int binary = 2;
    if ((byte(0) & 15) == binary) took_frame(head, report);
    received_.erase(0, head + size);
    return true;
  }

  void took_frame(std::size_t at, ClientReport& report) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(received_.data()) + at;
    const auto header = protocol::decode_frame_header({bytes, received_.size() - at});
    if (!header) throw std::runtime_error("a frame without header");
    const double overhead = first_byte_us_ - static_cast<double>(header->render_start_us) -
                            header->render_us - header->encode_us;
    report.overhead_ms.push_back(overhead / 1000.0);
    report.disorder += header->frame_seq <= last_seq_ || header->render_id < last_render_;
    last_seq_ = header->frame_seq;
    last_render_ = header->render_id;
    ++frames;
    send_text(R"({"jsonrpc":"2.0","method":"stream.ack","params":{"frame_seq":)" +
              std::to_string(header->frame_seq) + "}}");
  }

  /// A masked text frame; the mask is zero.
  void send_text(const std::string& text) {
    std::string frame{'\x81', static_cast<char>(0x80 | (text.size() < 126 ? text.size() : 126))};
    if (text.size() >= 126) {
      frame += static_cast<char>(text.size() >> 8);
      frame += static_cast<char>(text.size() & 255);
    }
    frame.append(4, '\0');
    write(frame + text);
  }

  void write(const std::string& bytes) {
    if (send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("the server takes nothing");
    }
  }

  int socket_;
  std::string received_;
  double first_byte_us_ = 0.0;
  bool upgraded_ = false;
  std::uint32_t last_seq_ = 0;
  std::uint32_t last_render_ = 0;
};

}  // namespace

ClientReport watch(const ClientOptions& options) {
  std::vector<std::unique_ptr<Viewer>> viewers;
  std::vector<std::unique_ptr<Viewer>> stalled;
  for (std::size_t i = 0; i < options.viewers; ++i) {
    viewers.push_back(std::make_unique<Viewer>(options.port));
  }
  ClientReport report;
  const auto run_until = [&](auto done) {
    while (!done()) {
      std::vector<pollfd> waiting;
      for (const auto& viewer : viewers) {
        waiting.push_back({.fd = viewer->descriptor(), .events = POLLIN, .revents = 0});
      }
      poll(waiting.data(), waiting.size(), 50);
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        if (waiting[i].revents) viewers[i]->read(report);
      }
    }
  };
  run_until([&] {
    for (const auto& viewer : viewers) {
      if (viewer->frames == 0) return false;
    }
    return true;
  });
  const auto run_for = [&](double seconds) {
    const Clock::time_point end =
        Clock::now() + std::chrono::microseconds(static_cast<std::int64_t>(1e6 * seconds));
    run_until([&] { return Clock::now() >= end; });
  };
  std::printf("ready\n");
  std::fflush(stdout);
  report = {};
  for (const auto& viewer : viewers) viewer->frames = 0;
  if (options.stalled > 0) {
    run_for(options.seconds);
    for (const auto& viewer : viewers) {
      report.frames_before_stall.push_back(std::exchange(viewer->frames, 0));
    }
    for (std::size_t i = 0; i < options.stalled; ++i) {
      stalled.push_back(std::make_unique<Viewer>(options.port));
    }
  }
  run_for(options.seconds);
  for (const auto& viewer : viewers) report.frames.push_back(viewer->frames);
  return report;
}

}  // namespace heliograph::bench
