#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "protocol/messages/frame_header.hpp"

namespace heliograph::bench {

/// Microseconds of the monotonic clock, which frames are stamped with, too.
double now_us();

/// A frame as it has arrived.
struct ReceivedFrame {
  protocol::FrameHeader header;
  std::span<const std::uint8_t> payload;  // valid while it is taken
  double first_byte_us = 0.0;
};

/// One viewer's WebSocket (RFC 6455) to a server of this machine, read as its bytes come. Says
/// hello, and acknowledges every frame without decoding it.
class ViewerSocket {
 public:
  /// @throws std::runtime_error, like everything else
  explicit ViewerSocket(std::uint16_t port);
  ~ViewerSocket();
  ViewerSocket(const ViewerSocket&) = delete;
  ViewerSocket& operator=(const ViewerSocket&) = delete;

  int descriptor() const { return socket_; }
  void send_text(const std::string& text);
  /// Reads the bytes that have arrived; gives how many. `take` is called for every whole frame.
  std::uint64_t read(const std::function<void(const ReceivedFrame&)>& take);

 private:
  void upgrade(std::uint16_t port);
  bool take_message(const std::function<void(const ReceivedFrame&)>& take);
  void take_frame(std::span<const std::uint8_t> message,
                  const std::function<void(const ReceivedFrame&)>& take);
  void write(const std::string& bytes);

  int socket_;
  std::string received_;
  double first_byte_us_ = 0.0;
};

}  // namespace heliograph::bench
