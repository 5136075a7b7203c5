#pragma once

#include <chrono>
#include <cstdint>

namespace heliograph::net {

/// Whether the other end of a connection is still there: it is heard, be it by its answers to
/// pings, or goes on taking a message so long that a ping has to wait behind it.
class Presence {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Verdict {
    fine,
    silent,  // a ping is due
    gone,
  };

  /// `patience`: how long it may be silent. `slowest`: bytes a second that it must take of a long
  /// message. `interval`: how far apart the looks are.
  Presence(std::chrono::milliseconds patience, double slowest, std::chrono::milliseconds interval,
           Clock::time_point now);

  void heard(Clock::time_point now) { heard_ = now; }
  /// `write` numbers the message that is being written, 0 where none is; `taken` are all the bytes
  /// that the other end has taken so far.
  Verdict look(Clock::time_point now, std::uint64_t write, std::uint64_t taken);

 private:
  std::chrono::milliseconds patience_;
  double slowest_;
  std::chrono::milliseconds interval_;
  Clock::time_point heard_;
  std::uint64_t write_ = 0;  // at the last look
  std::uint64_t taken_ = 0;  // when it was last heard or seen to go on
};

}  // namespace heliograph::net
