#include "net/websocket/presence.hpp"

#include <utility>

namespace heliograph::net {

Presence::Presence(std::chrono::milliseconds patience, double slowest,
                   std::chrono::milliseconds interval, Clock::time_point now)
    : patience_(patience), slowest_(slowest), interval_(interval), heard_(now) {}

Presence::Verdict Presence::look(Clock::time_point now, std::uint64_t write, std::uint64_t taken) {
  const bool same_message = std::exchange(write_, write) == write && write != 0;
  if (!same_message) {
    taken_ = taken;
  } else {
    const std::chrono::duration<double> silence = now - heard_;
    if (static_cast<double>(taken - taken_) >= slowest_ * silence.count()) {
      heard_ = now;
      taken_ = taken;
    }
  }
  const Clock::duration silence = now - heard_;
  if (silence > patience_) return Verdict::gone;
  // The next look would be too late for a ping every half of it.
  return silence > patience_ / 2 - interval_ ? Verdict::silent : Verdict::fine;
}

}  // namespace heliograph::net
