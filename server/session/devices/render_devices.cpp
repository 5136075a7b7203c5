#include "session/devices/render_devices.hpp"

#include <algorithm>
#include <utility>

namespace heliograph::session {

RenderDevices::RenderDevices(const render::Engines& engines, Clock::duration release_after)
    : engines_(engines) {
  for (render::Engine& engine : engines_) {
    loops_.push_back(std::make_unique<RenderLoop>(
        engine, measurements_,
        RenderLoopOptions{.release_after = release_after, .loops = engines_.size()}));
  }
}

std::shared_ptr<Session> RenderDevices::open(SessionOptions options, PixelShare pixels) {
  if (!options.device) options.device = place(options);
  RenderLoop& loop = *loops_[*options.device];
  return loop.open(std::move(options), std::move(pixels));
}

std::size_t RenderDevices::place(const SessionOptions& options) const {
  if (loops_.size() == 1 || options.name == protocol::main_session) return 0;
  std::vector<DeviceLoad> loads;
  for (const auto& loop : loops_) loads.push_back(loop->load());
  return place_session(loads,
                       session_memory(static_cast<std::uint64_t>(options.width) * options.height));
}

void RenderDevices::close(const Session& session) {
  loops_[session.device()]->close(session);
}

bool RenderDevices::ready() const {
  return std::ranges::any_of(loops_, [](const auto& loop) { return loop->device_ready(); });
}

Clock::duration RenderDevices::still_for() const {
  Clock::duration shortest = Clock::duration::max();
  for (const auto& loop : loops_) shortest = std::min(shortest, loop->still_for());
  return shortest;
}

bool RenderDevices::are_occupied() const {
  return std::ranges::any_of(loops_, [](const auto& loop) { return loop->is_occupied(); });
}

bool RenderDevices::images_move() const {
  return std::ranges::any_of(loops_, [](const auto& loop) { return loop->images_move(); });
}

void RenderDevices::on_first_frame(std::function<void()> callback) {
  loops_.front()->on_first_frame(std::move(callback));
}

void RenderDevices::stop() {
  for (const auto& loop : loops_) loop->stop();
}

}  // namespace heliograph::session
