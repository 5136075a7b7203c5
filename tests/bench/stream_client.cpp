#include "tests/bench/stream_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>

#include "protocol/messages/frame_header.hpp"

namespace heliograph::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int binary_message = 2;
constexpr std::size_t most_at_once = 1 << 18;

double now_us() {
  return std::chrono::duration<double, std::micro>(Clock::now().time_since_epoch()).count();
}

/// One WebSocket (RFC 6455), read as its bytes come.
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
    upgrade(port);
    send_text(R"({"jsonrpc":"2.0","id":1,"method":"hello","params":{"client":"benchmark"}})");
    send_text(R"({"jsonrpc":"2.0","method":"stream.configure","params":{"max_fps":240}})");
  }
  ~Viewer() { close(socket_); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  int descriptor() const { return socket_; }

  /// Reads the bytes that have arrived.
  void read(ClientReport& report) {
    const std::size_t before = received_.size();
    received_.resize(before + most_at_once);
    const ssize_t count = recv(socket_, received_.data() + before, most_at_once, MSG_DONTWAIT);
    received_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count == 0) throw std::runtime_error("the server has closed the connection");
    if (count < 0) return;
    if (before == 0) first_byte_us_ = now_us();
    report.bytes += static_cast<std::uint64_t>(count);
    while (take_message(report)) first_byte_us_ = now_us();
  }

  std::uint64_t frames = 0;

 private:
  /// Nothing may be sent before the response.
  void upgrade(std::uint16_t port) {
    write("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
          "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
          "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
          "Sec-WebSocket-Protocol: heliograph.v1\r\n\r\n");
    std::string answer;
    while (!answer.ends_with("\r\n\r\n")) {
      char next = 0;
      if (recv(socket_, &next, 1, 0) != 1) throw std::runtime_error("the server does not answer");
      answer += next;
    }
    if (!answer.starts_with("HTTP/1.1 101")) {
      throw std::runtime_error("the server rejects the WebSocket: " + answer);
    }
  }

  /// Removes the first complete message from the received bytes.
  bool take_message(ClientReport& report) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(received_[i]); };
    if (received_.size() < 2) return false;
    std::size_t head = 2;
    std::uint64_t size = byte(1) & 127;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (received_.size() < head + more) return false;
    if (more > 0) size = 0;
    for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte(head + i);
    head += more;
    if (received_.size() < head + size) return false;
    if ((byte(0) & 15) == binary_message) took_frame(head, report);
    received_.erase(0, head + size);
    return true;
  }

  void took_frame(std::size_t at, ClientReport& report) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(received_.data()) + at;
    const auto header = protocol::decode_frame_header({bytes, received_.size() - at});
    if (!header) throw std::runtime_error("a frame without header");
    send_text(R"({"jsonrpc":"2.0","method":"stream.ack","params":{"frame_seq":)" +
              std::to_string(header->frame_seq) + "}}");
    if (header->full_width != shown_width) return;  // rendered by the session itself
    const double overhead = first_byte_us_ - static_cast<double>(header->render_start_us) -
                            header->render_us - header->encode_us;
    report.overhead_ms.push_back(overhead / 1000.0);
    report.disorder += header->frame_seq <= last_seq_ || header->render_id < last_render_;
    report.adapted += header->width != shown_width || header->quality != shown_quality;
    last_seq_ = header->frame_seq;
    last_render_ = header->render_id;
    ++frames;
  }

  /// A masked text frame; the mask is zero.
  void send_text(const std::string& text) {
    std::string frame{'\x81'};
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      frame += '\xfe';
      frame += static_cast<char>(text.size() >> 8);
      frame += static_cast<char>(text.size() & 255);
    }
    frame.append(4, '\0');
    write(frame + text);
  }

  void write(const std::string& bytes) {
    if (send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("cannot write to the server");
    }
  }

  int socket_;
  std::string received_;
  double first_byte_us_ = 0.0;
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
