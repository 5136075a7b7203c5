#include "session/session_camera.hpp"

namespace heliograph::session {

using protocol::Camera;
using protocol::Result;

Result<Camera> SessionCamera::get() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return core_.camera.message(core_.rev);
}

std::uint64_t SessionCamera::moves() const {
  const std::lock_guard lock(core_.mutex);
  return core_.camera.moves();
}

Result<Camera> SessionCamera::set(const protocol::CameraSet& request, const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const auto set = core_.camera.set(request, *core_.scene, by); !set) return set.error();
  return publish(by);
}

Result<Camera> SessionCamera::orbit(const protocol::CameraOrbit& request, const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const auto moved = core_.camera.orbit(request, by); !moved) return moved.error();
  return publish(by);
}

Result<Camera> SessionCamera::fit(const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  core_.camera.fit(*core_.scene, core_.aspect());
  return publish(by);
}

Camera SessionCamera::publish(const std::string& by) {
  core_.changed();
  const protocol::CameraChanged message{.camera = core_.camera.message(core_.rev), .by = by};
  core_.notify_others_latest<protocol::notifications::camera_changed>(by, message);
  return message.camera;
}

}  // namespace heliograph::session
