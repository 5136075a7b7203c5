#include "session/devices/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace heliograph::session {
namespace {

constexpr double busy_window = 5.0;  // seconds
/// What a session counts for beside its time: so many are as bad as a busy device.
constexpr double sessions_like_busy = 10.0;
/// Images and histories, the path tracer's and those of the JPEG encoder included.
constexpr std::uint64_t bytes_per_pixel = 600;
constexpr std::uint64_t scene_bytes = 256ull << 20;

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void BusyShare::add(Clock::time_point begin, Clock::time_point end) {
  const double before = at(end) * busy_window;
  seconds_ = before + busy_window * (1.0 - std::exp(-seconds(end - begin) / busy_window));
  updated_ = end;
}

double BusyShare::at(Clock::time_point now) const {
  const double share = seconds_ / busy_window;
  return std::min(1.0, share * std::exp(-std::max(0.0, seconds(now - updated_)) / busy_window));
}

std::uint64_t session_memory(std::uint64_t pixels) {
  return pixels * bytes_per_pixel + scene_bytes;
}

std::size_t place_session(std::span<const DeviceLoad> devices, std::uint64_t memory) {
  const auto order = [&](const DeviceLoad& device) {
    const std::uint64_t free =
        device.free_memory.value_or(std::numeric_limits<std::uint64_t>::max());
    const double load = device.busy + static_cast<double>(device.sessions) / sessions_like_busy;
    return std::tuple(!device.ready, free < memory, load,
                      std::numeric_limits<std::uint64_t>::max() - free);
  };
  return static_cast<std::size_t>(std::ranges::min_element(devices, {}, order) - devices.begin());
}

}  // namespace heliograph::session
