#include "tests/bench/viewers/viewer_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace heliograph::bench {
namespace {

constexpr int binary_message = 2;
constexpr std::size_t most_at_once = 1 << 18;

}  // namespace

double now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::micro>(now).count();
}

ViewerSocket::ViewerSocket(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
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
}

ViewerSocket::~ViewerSocket() {
  close(socket_);
}

/// Nothing may be sent before the response.
void ViewerSocket::upgrade(std::uint16_t port) {
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

std::uint64_t ViewerSocket::read(const std::function<void(const ReceivedFrame&)>& take) {
  const std::size_t before = received_.size();
  received_.resize(before + most_at_once);
  const ssize_t count = recv(socket_, received_.data() + before, most_at_once, MSG_DONTWAIT);
  received_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (count == 0) throw std::runtime_error("the server has closed the connection");
  if (count < 0) return 0;
  if (before == 0) first_byte_us_ = now_us();
  while (take_message(take)) first_byte_us_ = now_us();
  return static_cast<std::uint64_t>(count);
}

/// Removes the first complete message from the received bytes.
bool ViewerSocket::take_message(const std::function<void(const ReceivedFrame&)>& take) {
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
  if ((byte(0) & 15) == binary_message) {
    const auto* const message = reinterpret_cast<const std::uint8_t*>(received_.data()) + head;
    take_frame({message, static_cast<std::size_t>(size)}, take);
  }
  received_.erase(0, head + size);
  return true;
}

void ViewerSocket::take_frame(std::span<const std::uint8_t> message,
                              const std::function<void(const ReceivedFrame&)>& take) {
  const auto header = protocol::decode_frame_header(message);
  if (!header) throw std::runtime_error("a frame without header");
  send_text(R"({"jsonrpc":"2.0","method":"stream.ack","params":{"frame_seq":)" +
            std::to_string(header->frame_seq) + "}}");
  take({.header = *header,
        .payload = message.subspan(header->header_bytes),
        .first_byte_us = first_byte_us_});
}

/// A masked text frame; the mask is zero.
void ViewerSocket::send_text(const std::string& text) {
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

void ViewerSocket::write(const std::string& bytes) {
  if (send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("cannot write to the server");
  }
}

}  // namespace heliograph::bench
