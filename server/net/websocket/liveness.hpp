#pragma once

#include <chrono>
#include <cstdint>

namespace heliograph::net {

/// Whether the peer is still connected: it sends something, such as pongs, or keeps acknowledging
/// bytes of a message so long that a ping has to wait behind it.
class Liveness {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Verdict {
    alive,
    silent,  // a ping is due
    lost,
  };

  /// `timeout`: after this silence the peer is lost. `min_rate`: bytes per second of a long message
  /// that count as a sign of life. `interval`: time between checks.
  Liveness(std::chrono::milliseconds timeout, double min_rate, std::chrono::milliseconds interval,
           Clock::time_point now);

  void received(Clock::time_point now) { received_ = now; }
  /// `write` numbers the message that is being written, 0 if none is; `acknowledged`: all bytes
  /// that the peer's system has acknowledged so far.
  Verdict check(Clock::time_point now, std::uint64_t write, std::uint64_t acknowledged);

 private:
  std::chrono::milliseconds timeout_;
  double min_rate_;
  std::chrono::milliseconds interval_;
  Clock::time_point received_;
  std::uint64_t write_ = 0;         // at the last check
  std::uint64_t acknowledged_ = 0;  // at the last sign of life
};

}  // namespace heliograph::net
