#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Which part of the time a device works: the mean of the last seconds, in which older ones count
/// less. Not thread safe.
class BusyShare {
 public:
  /// It worked from `begin` to `end`.
  void add(Clock::time_point begin, Clock::time_point end);
  /// 0..1
  double at(Clock::time_point now) const;

 private:
  double seconds_ = 0.0;  // of work, as they count at `updated_`
  Clock::time_point updated_{};
};

/// What decides whether a new session is placed on a device.
struct DeviceLoad {
  bool ready = true;                         // it is not lost
  double busy = 0.0;                         // part of the time for which it works, 0..1
  std::size_t sessions = 0;                  // on it, idle ones included
  std::optional<std::uint64_t> free_memory;  // bytes; absent: the device does not tell
};

/// Memory that a session with frames of so many pixels may take of its device, with its scene.
std::uint64_t session_memory(std::uint64_t pixels);

/// The index of the device for a new session that takes `memory` bytes: one that is not lost, with
/// enough memory, and the least loaded of these. Sessions count beside the time that they take now,
/// since new ones have not taken any yet and idle ones may move again. @pre there is a device
std::size_t place_session(std::span<const DeviceLoad> devices, std::uint64_t memory);

}  // namespace heliograph::session
